#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string_view>

#include "common/artifact/meshfile/formats.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/core/error.h"

namespace strake::meshfile {
namespace {

/// Where the values of a row of an element go: property indices, -1 of what is not there.
struct RowTargets {
  std::array<int, 3> coordinates = {-1, -1, -1};  ///< x, y, z
  std::array<int, 4> colour = {-1, -1, -1, -1};   ///< red, green, blue, alpha
  std::array<int, 2> texture = {-1, -1};          ///< of vertices
  int list = -1;                                  ///< of vertices
  int texture_list = -1;                          ///< two numbers for each corner
  std::vector<int> labels;
};

/// Adds a count that the file states, which may be any number.
void add_stated(std::uint64_t count, std::int64_t& sum) {
  const auto room = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max() - sum);
  sum += static_cast<std::int64_t>(std::min(count, room));
}

bool is_integer(PlyType type) { return type != PlyType::float32 && type != PlyType::float64; }

/// The place of a name among some; -1 where it is none of them.
template <std::size_t N>
int place_of(std::string_view name, const std::array<std::string_view, N>& names) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? -1 : static_cast<int>(found - names.begin());
}

void find_vertex_target(const PlyProperty& property, int p, RowTargets& targets) {
  constexpr std::array<std::string_view, 3> kCoordinates = {"x", "y", "z"};
  constexpr std::array<std::string_view, 4> kColours = {"red", "green", "blue", "alpha"};
  constexpr std::array<std::string_view, 6> kTexture = {"s", "t",         "u",
                                                        "v", "texture_u", "texture_v"};
  if (const int i = place_of(property.name, kCoordinates); i >= 0) targets.coordinates[i] = p;
  if (const int i = place_of(property.name, kColours); i >= 0) targets.colour[i] = p;
  if (const int i = place_of(property.name, kTexture); i >= 0) targets.texture[i % 2] = p;
}

void find_face_target(const PlyProperty& property, int p, RowTargets& targets) {
  if (!property.is_list) {
    if (is_integer(property.type) && is_label_name(property.name)) targets.labels.push_back(p);
  } else if (property.name == "vertex_indices" || property.name == "vertex_index") {
    targets.list = p;
  } else if (property.name == "texcoord") {
    targets.texture_list = p;
  }
}

/// Whether the first `count` of these properties are there.
template <std::size_t N>
bool has_all(const std::array<int, N>& properties, std::size_t count = N) {
  return std::all_of(properties.begin(), properties.begin() + count,
                     [](int property) { return property >= 0; });
}

/// A colour as a share of the largest value of its type; floating-point numbers as they are.
double colour_of(double value, PlyType type) {
  if (!is_integer(type)) return value;
  const double scale = 1 / (std::exp2(8.0 * static_cast<double>(size_of(type))) - 1);
  return std::isfinite(value) ? std::clamp(value * scale, 0.0, 1.0) : 0;
}

RowTargets find_targets(const PlyElement& element) {
  RowTargets targets;
  for (int p = 0; p < static_cast<int>(element.properties.size()); ++p) {
    const PlyProperty& property = element.properties[p];
    if (element.name != "vertex") {
      find_face_target(property, p, targets);
    } else if (!property.is_list) {
      find_vertex_target(property, p, targets);
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

/// A label is a number of 32 bits, with a sign or without: those without from 2^31 on are told
/// apart as what they are with one.
Index label_of(double value) {
  if (value > INT32_MAX && value <= UINT32_MAX) {
    return static_cast<Index>(static_cast<std::uint32_t>(value));
  }
  return static_cast<Index>(std::clamp<double>(value, INT32_MIN, INT32_MAX));
}

/// Reads the rows of one element from a source of values; the source tells where data ends.
template <typename Source>
class ElementReader {
 public:
  /// \param vertex_texture  [V] filled from vertices, to be given to corners in the end
  ElementReader(Source& source, const PlyElement& element, PolyMesh& mesh,
                std::vector<TexturePoint>& vertex_texture, ReadReport& report)
      : source_(source),
        element_(element),
        targets_(find_targets(element)),
        mesh_(mesh),
        vertex_texture_(vertex_texture),
        report_(report) {
    if (element.name != "face") targets_.labels.clear();
    for (const int p : targets_.labels) {
      mesh_.attributes.labels.push_back({element.properties[p].name, {}, {}});
    }
    label_.resize(targets_.labels.size());
  }

  /// \return whether all rows were there
  bool read() {
    const bool vertices = element_.name == "vertex";
    const bool faces = element_.name == "face" && targets_.list >= 0;
    const bool strips = element_.name == "tristrips" && targets_.list >= 0;
    if (vertices && !has_all(targets_.coordinates)) {
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
      texture_list_.clear();
      if (!read_row()) {
        if (vertices) add_stated(element_.count - row, report_.missing_vertices);
        if (faces || strips) add_stated(element_.count - row, report_.missing_faces);
        return false;
      }
      if (vertices) add_vertex();
      if (faces) add_face();
      if (faces) check_countable(mesh_.corners.size(), "face corners");
      if (strips) add_strips(list_, mesh_);
    }
    return true;
  }

 private:
  void add_vertex() {
    mesh_.positions.push_back(position_);
    if (has_all(targets_.colour, 3)) mesh_.attributes.colour.push_back(colour_);
    if (has_all(targets_.texture)) vertex_texture_.push_back(texture_);
  }

  void add_face() {
    mesh_.add_face(list_);
    for (std::size_t i = 0; i < label_.size(); ++i) {
      mesh_.attributes.labels[i].of_face.push_back(label_[i]);
    }
    if (targets_.texture_list < 0) return;
    // A corner with but one number has no coordinates.
    const std::size_t textured = std::min(texture_list_.size() / 2, list_.size());
    report_.untextured_corners += static_cast<std::int64_t>(list_.size() - textured);
    texture_list_.resize(2 * textured);
    texture_list_.resize(2 * list_.size(), 0);
    for (std::size_t i = 0; i < list_.size(); ++i) {
      mesh_.attributes.texture.push_back({texture_list_[2 * i], texture_list_[2 * i + 1]});
    }
  }

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
    const double finite = std::isfinite(value) ? value : 0;
    for (int i = 0; i < 4; ++i) {
      if (targets_.colour[i] == p) colour_[i] = colour_of(value, property.type);
    }
    for (int i = 0; i < 2; ++i) {
      if (targets_.texture[i] == p) texture_[i] = finite;
    }
    for (std::size_t i = 0; i < label_.size(); ++i) {
      if (targets_.labels[i] != p) continue;
      label_[i] = label_of(finite);
    }
    return true;
  }

  bool read_list(int p, const PlyProperty& property) {
    std::int64_t count = 0;
    if (!source_.integer(property.count_type, count) || count < 0) return false;
    if (static_cast<std::uint64_t>(count) > source_.remaining()) return false;
    if (p == targets_.texture_list) {
      for (std::int64_t i = 0; i < count; ++i) {
        double value = 0;
        if (!source_.real(property.type, value)) return false;
        texture_list_.push_back(std::isfinite(value) ? value : 0);
      }
      return true;
    }
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
  std::vector<TexturePoint>& vertex_texture_;
  ReadReport& report_;
  Vec3 position_ = Vec3::Zero();
  Colour colour_ = {1, 1, 1, 1};
  TexturePoint texture_ = {};
  std::vector<Index> list_;
  std::vector<double> texture_list_;
  std::vector<Index> label_;  ///< one for each of targets_.labels
};

/// Drops what only some elements of a damaged or odd file have, and gives vertices' texture
/// coordinates to their corners where faces have none of their own.
void complete_attributes(PolyMesh& mesh, const std::vector<TexturePoint>& vertex_texture,
                         ReadReport& report) {
  Attributes& attributes = mesh.attributes;
  const auto faces = static_cast<std::size_t>(mesh.face_count());
  std::erase_if(attributes.labels, [&](const FaceLabels& l) { return l.of_face.size() != faces; });
  if (attributes.colour.size() != mesh.positions.size()) attributes.colour.clear();
  const auto untextured = static_cast<std::size_t>(report.untextured_corners);
  if (attributes.texture.size() != mesh.corners.size() || untextured == mesh.corners.size()) {
    attributes.texture.clear();
    report.untextured_corners = 0;
  }
  if (!attributes.texture.empty() || vertex_texture.empty()) return;
  attributes.texture.reserve(mesh.corners.size());
  for (const Index v : mesh.corners) {
    const bool is_there = v >= 0 && static_cast<std::size_t>(v) < vertex_texture.size();
    attributes.texture.push_back(is_there ? vertex_texture[v] : TexturePoint{});
  }
}

/// What an element that is never reached because the data ended before it leaves missing.
void count_unreached(const PlyElement& element, ReadReport& report) {
  if (element.name == "vertex") add_stated(element.count, report.missing_vertices);
  if (element.name == "face" || element.name == "tristrips") {
    add_stated(element.count, report.missing_faces);
  }
}

template <typename Source>
PolyMesh read_elements(Source source, const PlyHeader& header, ReadReport& report) {
  PolyMesh mesh;
  std::vector<TexturePoint> vertex_texture;
  bool complete = true;
  for (const PlyElement& element : header.elements) {
    if (!complete) {
      count_unreached(element, report);
    } else if (!element.properties.empty()) {
      complete = ElementReader<Source>(source, element, mesh, vertex_texture, report).read();
    }
  }
  complete_attributes(mesh, vertex_texture, report);
  return mesh;
}

}  // namespace

bool is_label_name(std::string_view name) {
  for (const std::string_view known :
       {"label", "labels", "segment", "segment_id", "region", "group", "part", "patch", "material",
        "material_index", "object", "category", "o", "g", "usemtl"}) {
    if (name == known) return true;
  }
  return false;
}

PolyMesh read_ply(std::string_view bytes, ReadReport& report) {
  report.format = "PLY";
  const PlyHeader header = read_ply_header(bytes, report);
  report.format = header.encoding == PlyEncoding::ascii           ? "PLY, ascii"
                  : header.encoding == PlyEncoding::little_endian ? "PLY, binary little-endian"
                                                                  : "PLY, binary big-endian";
  return with_values(bytes, header,
                     [&](const auto& source) { return read_elements(source, header, report); });
}

}  // namespace strake::meshfile
