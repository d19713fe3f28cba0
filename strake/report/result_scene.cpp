#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "common/geometry/poly_topology/face_shape.h"
#include "strake/report/quantise.h"
#include "strake/report/scene.h"

namespace strake::report {
namespace {

/// One face as the viewer gets it.
struct FaceRow {
  std::uint8_t sides = 0;
  std::uint8_t shape = 0;      ///< angle to the curvature in half degrees, or kNoAngle; + kConcave
  std::uint16_t distance = 0;  ///< share of the largest one
};
constexpr std::uint8_t kNoAngle = 127;
constexpr std::uint8_t kConcave = 128;

std::uint8_t shape_of(bool is_concave, double angle_deg) {
  const auto angle =
      angle_deg < 0 ? kNoAngle : static_cast<std::uint8_t>(std::lround(2 * angle_deg));
  return static_cast<std::uint8_t>(angle | (is_concave ? kConcave : 0));
}

bool is_closed(const PolyEdges& edges) {
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() != 2) return false;
  }
  return true;
}

}  // namespace

const FaceLabels* telling_labels(const std::vector<FaceLabels>& kinds) {
  const FaceLabels* best = nullptr;
  std::size_t most = 0;
  for (const FaceLabels& kind : kinds) {
    const std::size_t parts = std::set<Index>(kind.of_face.begin(), kind.of_face.end()).size();
    if (parts <= most) continue;
    best = &kind;
    most = parts;
  }
  return best;
}

nlohmann::ordered_json result_scene(const VertexProvenance& provenance, const ResultEdges& result,
                                    const ErrorMap& errors, Blocks& blocks) {
  const PolyMesh& mesh = result.mesh;
  const std::vector<Vec3>& positions = mesh.positions;
  const Grid grid(positions);
  std::vector<GridPoint> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.push_back(grid.quantise(p));

  const std::vector<double> angles = result.face_angles();
  double largest = 0;
  for (const CellError& cell : errors.cells) largest = std::max(largest, cell.largest);
  std::vector<FaceRow> faces;
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<Index, 3>> of_face;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    of_face.clear();
    triangulate_face(positions, face, of_face);
    for (const auto& corners : of_face) {
      for (const Index v : corners) triangles.push_back(static_cast<std::uint32_t>(v));
    }
    faces.push_back({static_cast<std::uint8_t>(std::min<std::size_t>(face.size(), 255)),
                     shape_of(is_concave_face(positions, face), angles.empty() ? -1 : angles[f]),
                     quantise_share(largest > 0 ? errors.cells[f].largest / largest : 0)});
  }
  nlohmann::ordered_json scene = {
      {"vertices", mesh.vertex_count()},
      {"faces", mesh.face_count()},
      {"is_closed", is_closed(result.edges)},
      {"low", {grid.low().x(), grid.low().y(), grid.low().z()}},
      {"step", grid.step()},
      {"positions", blocks.vertices(points)},
      {"triangles", blocks.triangles(triangles)},
      {"face_rows", blocks.vertices(faces)},
      {"largest_distance", largest},
      {"rms_distance", errors.rms},
  };
  if (!provenance.lines.empty()) {
    std::vector<std::array<std::uint32_t, 2>> lines;
    for (const auto& [a, b] : provenance.lines) {
      lines.push_back({static_cast<std::uint32_t>(a + 1), static_cast<std::uint32_t>(b + 1)});
    }
    scene["vertex_lines"] = blocks.vertices(lines);
  }
  if (!mesh.attributes.colour.empty()) {
    scene["colours"] = blocks.vertices(quantise_colours(mesh.attributes.colour));
  }
  if (const FaceLabels* labels = telling_labels(mesh.attributes.labels)) {
    scene["labels"] = {{"kind", labels->name},
                       {"names", labels->names},
                       {"of_face", blocks.vertices(labels->of_face)}};
  }
  return scene;
}

}  // namespace strake::report
