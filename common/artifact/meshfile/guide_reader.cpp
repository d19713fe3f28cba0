#include "common/artifact/meshfile/guide_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "common/artifact/meshfile/mapped_file.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_row.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/artifact/meshfile/text_scanner.h"
#include "common/core/error.h"
#include "common/core/text.h"

namespace strake {
namespace {

using namespace meshfile;

/// Points and the guides that join them, on the way from a file. Elements are counted from 1.
class GuideBuilder {
 public:
  explicit GuideBuilder(const std::string& name) { guides_.name = name; }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("'{}' {}", guides_.name, what));
  }

  [[nodiscard]] std::int64_t point_count() const {
    return static_cast<std::int64_t>(points_.size());
  }

  void add_point(const Vec3& point) {
    points_.push_back(point);
    if (!point.allFinite()) {
      fail(fmt::format("has a coordinate that is no finite number, at vertex {}", points_.size()));
    }
  }

  void begin_guide() { guides_.lines.emplace_back(); }
  /// \param number  of a point, from 1
  void extend_guide(std::int64_t number) {
    if (number < 1 || number > point_count()) {
      fail(fmt::format("names vertex {} in guide {}, but has {} vertices up to there", number,
                       guides_.lines.size(), points_.size()));
    }
    guides_.lines.back().push_back(points_[static_cast<std::size_t>(number - 1)]);
  }
  void end_guide() {
    if (guides_.lines.back().size() < 2) {
      fail(fmt::format("has fewer than two points in guide {}", guides_.lines.size()));
    }
  }

  GuideLines finish() {
    if (guides_.lines.empty()) {
      fail("holds no guide line: guides are the elements 'l' of OBJ, or the edges of PLY");
    }
    return std::move(guides_);
  }

 private:
  std::vector<Vec3> points_;
  GuideLines guides_;
};

/// "l 1 2 3", indices from 1, or from the end where they are negative, with or without "/vt".
void read_line_element(TextScanner& scanner, GuideBuilder& builder) {
  builder.begin_guide();
  while (scanner.skip_blanks()) {
    std::int64_t index = 0;
    if (!scanner.integer(index)) index = 0;
    scanner.skip_word();
    builder.extend_guide(index < 0 ? builder.point_count() + 1 + index : index);
  }
  builder.end_guide();
}

GuideLines parse_obj(std::string_view bytes, GuideBuilder builder) {
  TextScanner scanner(bytes, '#');
  for (; scanner.skip_space(); scanner.next_line()) {
    const std::string_view word = scanner.word();
    if (word == "v") {
      Vec3 point;
      for (int i = 0; i < 3; ++i) scanner.number(point[i]);
      builder.add_point(point);
    } else if (word == "l") {
      read_line_element(scanner, builder);
    }
  }
  return builder.finish();
}

template <class Source>
GuideLines parse_ply(Source source, const PlyHeader& header, GuideBuilder builder) {
  for (const PlyElement& element : header.elements) {
    const bool has_points = element.name == "vertex";
    const bool has_edges = element.name == "edge";
    std::vector<std::size_t> columns;
    for (const char* name : has_points  ? std::vector<const char*>{"x", "y", "z"}
                            : has_edges ? std::vector<const char*>{"vertex1", "vertex2"}
                                        : std::vector<const char*>{}) {
      const auto column = number_column(element, name);
      if (!column) builder.fail(fmt::format("has no property '{}' of '{}'", name, element.name));
      columns.push_back(*column);
    }
    for (std::uint64_t row = 0; row < element.count && !element.properties.empty(); ++row) {
      std::array<double, 3> values = {};
      if (!read_row(source, element, columns, values)) {
        builder.fail(fmt::format("ends before {} {} of {}", element.name, row + 1, element.count));
      }
      if (has_points) builder.add_point({values[0], values[1], values[2]});
      if (!has_edges) continue;
      builder.begin_guide();
      for (const double index : {values[0], values[1]}) {
        if (!(index >= 0 && index < static_cast<double>(builder.point_count()))) {
          builder.fail(fmt::format("names vertex {:g} in edge {}, counted from 0, but has {}",
                                   index, row, builder.point_count()));
        }
        builder.extend_guide(static_cast<std::int64_t>(index) + 1);
      }
    }
  }
  return builder.finish();
}

}  // namespace

GuideLines parse_guides(std::string_view bytes, const std::string& name) {
  GuideBuilder builder(name);
  bytes = without_byte_order_mark(bytes);
  if (!bytes.starts_with("ply")) return parse_obj(bytes, std::move(builder));
  ReadReport report;
  PlyHeader header;
  try {
    header = read_ply_header(bytes, report);
  } catch (const InputError& error) {
    builder.fail(error.what());
  }
  return with_values(bytes, header, [&](const auto& source) {
    return parse_ply(source, header, std::move(builder));
  });
}

GuideLines read_guides(const std::filesystem::path& path) {
  const MappedFile file(path);
  return parse_guides(file.bytes(), path.string());
}

}  // namespace strake
