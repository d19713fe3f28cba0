#include "common/artifact/edge_list_file.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/artifact/meshfile/mapped_file.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"
#include "common/core/text.h"

namespace strake {
namespace {

[[noreturn]] void fail(const EdgeList& list, int line, const std::string& what) {
  throw InputError(
      fmt::format("'{}', line {}: {}; write two or more vertex numbers, counted from "
                  "0 and separated by blanks",
                  list.name, line, what));
}

Index read_vertex(std::string_view word, const EdgeList& list, int line) {
  meshfile::TextScanner scanner(word);
  std::int64_t number = -1;
  const bool is_number = scanner.integer(number) && scanner.at_end();
  if (!is_number || number < 0 || number > INT32_MAX) {
    fail(list, line, fmt::format("'{}' is no vertex number", word));
  }
  return static_cast<Index>(number);
}

void read_line(std::string_view text, int line, EdgeList& list) {
  meshfile::TextScanner scanner(text);
  int count = 0;
  Index last = kNone;
  for (std::string_view word = scanner.word(); !word.empty(); word = scanner.word()) {
    const Index vertex = read_vertex(word, list, line);
    if (vertex == last) fail(list, line, fmt::format("vertex {} follows itself", vertex));
    if (count++ > 0) list.edges.push_back({last, vertex, line});
    last = vertex;
  }
  if (count == 1) fail(list, line, fmt::format("vertex {} stands alone", last));
}

}  // namespace

EdgeList parse_edge_list(std::string_view text, const std::string& name) {
  EdgeList list;
  list.name = name;
  text = without_byte_order_mark(text);
  for (int line = 1; !text.empty(); ++line) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    const std::string_view content = text.substr(0, end);
    read_line(content.substr(0, content.find('#')), line, list);
    text.remove_prefix(end);
    if (!text.empty()) text.remove_prefix(text.starts_with("\r\n") ? 2 : 1);
  }
  return list;
}

EdgeList read_edge_list(const std::filesystem::path& path) {
  const meshfile::MappedFile file(path);
  return parse_edge_list(file.bytes(), path.string());
}

}  // namespace strake
