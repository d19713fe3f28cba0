#include <algorithm>
#include <optional>
#include <string_view>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

/// Where the values of a row of an element go.
struct RowTargets {
  std::array<int, 3> coordinates = {-1, -1, -1};  ///< property indices of x, y, z
  int list = -1;                                  ///< property index of the vertex list
};

bool has_coordinates(const RowTargets& targets) {
  return std::all_of(targets.coordinates.begin(), targets.coordinates.end(),
                     [](int property) { return property >= 0; });
}

RowTargets find_targets(const PlyElement& element) {
  RowTargets targets;
  for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
    const PlyProperty& property = element.properties[p];
    if (element.name == "vertex" && !property.is_list) {
      for (int i = 0; i < 3; ++i) {
        if (property.name == std::string_view("xyz").substr(i, 1)) targets.coordinates[i] = p;
      }
    } else if (element.name != "vertex" && property.is_list &&
               (property.name == "vertex_indices" || property.name == "vertex_index")) {
      targets.list = p;
    }
  }
  return targets;
}

/// Appends the triangles of strips; -1 separates strips, every other triangle is turned over.
void add_strips(const std::vector<Index>& strip, PolyMesh& mesh) {
  std::size_t start = 0;
  for (std::size_t i = 0; i < strip.size(); ++i) {
    if (strip[i] == kNone) {
      start = i + 1;
    } else if (i >= start + 2) {
      const bool odd = (i - start) % 2 != 0;
      const std::array<Index, 3> triangle = {strip[odd ? i - 1 : i - 2], strip[odd ? i - 2 : i - 1],
                                             strip[i]};
      // Strips are joined by triangles without area; these are no faces of the model.
      if (triangle[0] == triangle[1] || triangle[1] == triangle[2] || triangle[2] == triangle[0]) {
        continue;
      }
      mesh.add_face(triangle);
    }
  }
  check_countable(mesh.corners.size(), "face corners");
}

/// Reads the rows of one element from a source of values; the source tells where data ends.
template <typename Source>
class ElementReader {
 public:
  ElementReader(Source& source, const PlyElement& element, PolyMesh& mesh, ReadReport& report)
      : source_(source),
        element_(element),
        targets_(find_targets(element)),
        mesh_(mesh),
        report_(report) {}

  /// \return whether all rows were there
  bool read() {
    const bool vertices = element_.name == "vertex";
    const bool faces = element_.name == "face" && targets_.list >= 0;
    const bool strips = element_.name == "tristrips" && targets_.list >= 0;
    if (vertices && !has_coordinates(targets_)) {
      throw InputError("is a PLY file whose vertices have no x, y and z");
    }
    const std::uint64_t possible = source_.remaining() / source_.smallest_row(element_) + 1;
    const std::uint64_t expected = std::min(element_.count, possible);
    check_countable(expected, "elements of one kind");
    if (vertices) mesh_.positions.reserve(expected);
    if (faces) mesh_.offsets.reserve(expected + 1);
    if (faces) mesh_.corners.reserve(3 * expected);
    for (std::uint64_t row = 0; row < element_.count; ++row) {
      list_.clear();
      if (!read_row()) {
        if (vertices) report_.missing_vertices = static_cast<std::int64_t>(element_.count - row);
        if (faces || strips) {
          report_.missing_faces += static_cast<std::int64_t>(element_.count - row);
        }
        return false;
      }
      if (vertices) mesh_.positions.push_back(position_);
      if (faces) mesh_.add_face(list_);
      if (faces) check_countable(mesh_.corners.size(), "face corners");
      if (strips) add_strips(list_, mesh_);
    }
    return true;
  }

 private:
  bool read_row() {
    if (!source_.begin_row()) return false;
    for (int p = 0; p < static_cast<int>(element_.properties.size()); ++p) {
      const PlyProperty& property = element_.properties[p];
      if (!(property.is_list ? read_list(p, property) : read_scalar(p, property))) return false;
    }
    source_.end_row();
    return true;
  }

  bool read_scalar(int p, const PlyProperty& property) {
    double value = 0;
    if (!source_.real(property.type, value)) return false;
    for (int i = 0; i < 3; ++i) {
      if (targets_.coordinates[i] == p) position_[i] = value;
    }
    return true;
  }

  bool read_list(int p, const PlyProperty& property) {
    std::int64_t count = 0;
    if (!source_.integer(property.count_type, count) || count < 0) return false;
    if (static_cast<std::uint64_t>(count) > source_.remaining()) return false;
    if (p != targets_.list) return source_.skip(property.type, count);
    for (std::int64_t i = 0; i < count; ++i) {
      std::int64_t index = 0;
      if (!source_.integer(property.type, index)) return false;
      list_.push_back(to_index(index));
    }
    return true;
  }

  Source& source_;
  const PlyElement& element_;
  RowTargets targets_;
  PolyMesh& mesh_;
  ReadReport& report_;
  Vec3 position_ = Vec3::Zero();
  std::vector<Index> list_;
};

/// What an element that is never reached because the data ended before it leaves missing.
void count_unreached(const PlyElement& element, ReadReport& report) {
  const auto count = static_cast<std::int64_t>(element.count);
  if (element.name == "vertex") report.missing_vertices += count;
  if (element.name == "face" || element.name == "tristrips") report.missing_faces += count;
}

template <typename Source>
PolyMesh read_elements(Source source, const PlyHeader& header, ReadReport& report) {
  PolyMesh mesh;
  bool complete = true;
  for (const PlyElement& element : header.elements) {
    if (!complete) {
      count_unreached(element, report);
    } else if (!element.properties.empty()) {
      complete = ElementReader<Source>(source, element, mesh, report).read();
    }
  }
  return mesh;
}

}  // namespace

PolyMesh read_ply(std::string_view bytes, ReadReport& report) {
  report.format = "PLY";
  const PlyHeader header = read_ply_header(bytes, report);
  const std::string_view data = bytes.substr(header.size);
  switch (header.encoding) {
    case PlyEncoding::ascii:
      report.format = "PLY, ascii";
      return read_elements(AsciiValues(data), header, report);
    case PlyEncoding::little_endian:
      report.format = "PLY, binary little-endian";
      return read_elements(BinaryValues<false>(data), header, report);
    case PlyEncoding::big_endian:
      break;
  }
  report.format = "PLY, binary big-endian";
  return read_elements(BinaryValues<true>(data), header, report);
}

}  // namespace strake::meshfile
