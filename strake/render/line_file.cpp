#include "strake/render/line_file.h"

#include <cstdint>
#include <fstream>
#include <sstream>

#include "common/core/error.h"
#include "common/core/number_text.h"
#include "common/core/text.h"

namespace strake {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, std::size_t line,
                       const std::string& what) {
  throw InputError(path.string() + ", line " + std::to_string(line) + ": " + what);
}

/// \return kNone where the word names no point that was read before
Index point_index(const std::string& word, const Polylines& lines) {
  const auto count = static_cast<std::int64_t>(lines.positions.size());
  const std::int64_t number = parse_whole_number(word).value_or(0);
  const std::int64_t index = number < 0 ? count + number : number - 1;
  return index < 0 || index >= count ? kNone : static_cast<Index>(index);
}

}  // namespace

Polylines read_polylines(const std::filesystem::path& path) {
  std::error_code ignored;
  std::ifstream in;  // opened only then: opening a pipe waits for somebody who writes into it
  if (std::filesystem::is_regular_file(path, ignored)) in.open(path);
  if (!in.is_open()) throw InputError("'" + path.string() + "' cannot be opened; check the name");
  Polylines result;
  std::string text;
  std::string group;
  for (std::size_t number = 1; std::getline(in, text); ++number) {
    if (number == 1) text = std::string(without_byte_order_mark(text));
    std::istringstream record(text);
    std::string word;
    record >> word;
    if (word == "v") {
      Vec3 p;
      if (!(record >> p.x() >> p.y() >> p.z())) fail(path, number, "a vertex needs 3 numbers");
      result.positions.push_back(p);
    } else if (word == "g") {
      group.clear();
      record >> group;
    } else if (word == "l") {
      Polylines::Line line{{}, group};
      while (record >> word) {
        line.points.push_back(point_index(word, result));
        if (line.points.back() == kNone) {
          fail(path, number, "'" + word + "' is not a vertex read before");
        }
      }
      if (line.points.size() < 2) fail(path, number, "a line needs at least 2 vertices");
      result.lines.push_back(std::move(line));
    }
  }
  if (result.lines.empty()) {
    throw InputError(path.string() + ": no 'l' records; expected an OBJ file with polylines");
  }
  return result;
}

}  // namespace strake
