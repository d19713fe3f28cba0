#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/geometry/poly_topology/face_shape.h"
#include "strake/report/quantise.h"
#include "strake/report/scene.h"

namespace strake::report {
namespace {

/// One face as the viewer gets it.
struct FaceRow {
  std::uint8_t sides = 0;
  std::uint8_t is_concave = 0;
  std::uint16_t distance = 0;  ///< share of the largest one
};

}  // namespace

nlohmann::ordered_json result_scene(const TriMesh& mesh, const QuadMesh& quads,
                                    const ErrorMap& errors, Blocks& blocks) {
  std::vector<Vec3> positions = quads.mesh.positions;
  for (Vec3& p : positions) p -= mesh.origin;
  const Grid grid(positions);
  std::vector<GridPoint> points;
  points.reserve(positions.size());
  for (const Vec3& p : positions) points.push_back(grid.quantise(p));

  double largest = 0;
  for (const CellError& cell : errors.cells) largest = std::max(largest, cell.largest);
  std::vector<FaceRow> faces;
  std::vector<std::uint32_t> triangles;
  std::vector<std::array<Index, 3>> of_face;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const auto face = quads.mesh.face(f);
    of_face.clear();
    triangulate_face(positions, face, of_face);
    for (const auto& corners : of_face) {
      for (const Index v : corners) triangles.push_back(static_cast<std::uint32_t>(v));
    }
    faces.push_back({static_cast<std::uint8_t>(std::min<std::size_t>(face.size(), 255)),
                     static_cast<std::uint8_t>(is_concave_face(positions, face)),
                     quantise_share(largest > 0 ? errors.cells[f].largest / largest : 0)});
  }
  nlohmann::ordered_json scene = {
      {"vertices", quads.mesh.vertex_count()},
      {"faces", quads.mesh.face_count()},
      {"low", {grid.low().x(), grid.low().y(), grid.low().z()}},
      {"step", grid.step()},
      {"positions", blocks.vertices(points)},
      {"triangles", blocks.triangles(triangles)},
      {"face_rows", blocks.vertices(faces)},
      {"largest_distance", largest},
      {"rms_distance", errors.rms},
  };
  if (!quads.provenance.lines.empty()) {
    std::vector<std::array<std::uint32_t, 2>> lines;
    for (const auto& [a, b] : quads.provenance.lines) {
      lines.push_back({static_cast<std::uint32_t>(a + 1), static_cast<std::uint32_t>(b + 1)});
    }
    scene["vertex_lines"] = blocks.vertices(lines);
  }
  return scene;
}

}  // namespace strake::report
