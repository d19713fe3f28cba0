#include "common/artifact/meshfile/ply_header.h"

#include <fmt/format.h>

#include <array>
#include <utility>

#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

PlyType read_type(std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, PlyType>, 16> kNames = {{
      {"char", PlyType::int8},
      {"int8", PlyType::int8},
      {"uchar", PlyType::uint8},
      {"uint8", PlyType::uint8},
      {"short", PlyType::int16},
      {"int16", PlyType::int16},
      {"ushort", PlyType::uint16},
      {"uint16", PlyType::uint16},
      {"int", PlyType::int32},
      {"int32", PlyType::int32},
      {"uint", PlyType::uint32},
      {"uint32", PlyType::uint32},
      {"float", PlyType::float32},
      {"float32", PlyType::float32},
      {"double", PlyType::float64},
      {"float64", PlyType::float64},
  }};
  for (const auto& [name, type] : kNames) {
    if (name == word) return type;
  }
  throw InputError(fmt::format("has a PLY header with the unknown type '{}'", word));
}

PlyEncoding read_encoding(std::string_view word) {
  if (word == "ascii") return PlyEncoding::ascii;
  if (word == "binary_little_endian") return PlyEncoding::little_endian;
  if (word == "binary_big_endian") return PlyEncoding::big_endian;
  throw InputError(fmt::format("has a PLY header with the unknown encoding '{}'", word));
}

PlyElement read_element(TextScanner& scanner) {
  PlyElement element;
  element.name = scanner.word();
  std::int64_t count = -1;
  scanner.skip_blanks();
  if (!scanner.integer(count) || count < 0) {
    throw InputError(
        fmt::format("has a PLY header without a sensible number of elements '{}'", element.name));
  }
  element.count = static_cast<std::uint64_t>(count);
  return element;
}

PlyProperty read_property(TextScanner& scanner) {
  PlyProperty property;
  std::string_view word = scanner.word();
  if (word == "list") {
    property.is_list = true;
    property.count_type = read_type(scanner.word());
    word = scanner.word();
  }
  property.type = read_type(word);
  property.name = scanner.word();
  return property;
}

}  // namespace

PlyHeader read_ply_header(std::string_view bytes, ReadReport& report) {
  PlyHeader header;
  bool has_encoding = false;
  TextScanner scanner(bytes);
  if (scanner.word() != "ply") throw InputError("does not begin with the word ply");
  scanner.next_line();
  while (scanner.skip_space()) {
    const std::string_view word = scanner.word();
    if (word == "end_header") {
      scanner.next_line();
      if (!has_encoding) throw InputError("has a PLY header without a format line");
      header.size = bytes.size() - scanner.remaining();
      return header;
    }
    if (word == "format") {
      header.encoding = read_encoding(scanner.word());
      has_encoding = true;
    } else if (word == "element") {
      header.elements.push_back(read_element(scanner));
    } else if (word == "property") {
      if (header.elements.empty()) {
        throw InputError("has a PLY header with a property before any element");
      }
      header.elements.back().properties.push_back(read_property(scanner));
    } else if (word != "comment" && word != "obj_info") {
      ++report.skipped_lines;
    }
    scanner.next_line();
  }
  throw InputError("has a PLY header without an end; the file is damaged");
}

}  // namespace strake::meshfile
