#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/segment.h"
#include "strake/chain/remesh.h"

namespace strake {
namespace {

/// A line on the torus, from one place to another: by angles around its axis and around its tube.
std::vector<Vec3> slanted(const Vec2& from, const Vec2& to) {
  std::vector<Vec3> line;
  constexpr int kPoints = 60;
  for (int i = 0; i <= kPoints; ++i) {
    const Vec2 at = from + i * (to - from) / kPoints;
    const double radius = kTorusMajorRadius + kTorusMinorRadius * std::cos(at.y());
    line.emplace_back(radius * std::cos(at.x()), radius * std::sin(at.x()),
                      kTorusMinorRadius * std::sin(at.y()));
  }
  return line;
}

/// Share of a line that is within a tenth of the mean edge of an edge.
double share_on_edges(const std::vector<Vec3>& line, const PolyMesh& mesh) {
  const PolyEdges edges = collect_edges(mesh);
  double mean = 0;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const auto& [a, b] = edges.vertices[e];
    mean += (mesh.positions[b] - mesh.positions[a]).norm() / edges.edge_count();
  }
  int on = 0;
  for (const Vec3& p : line) {
    double least = std::numeric_limits<double>::infinity();
    for (Index e = 0; e < edges.edge_count(); ++e) {
      const auto& [a, b] = edges.vertices[e];
      least = std::min(least, way_to_segment(p, mesh.positions[a], mesh.positions[b]).norm());
    }
    on += least < 0.1 * mean ? 1 : 0;
  }
  return double(on) / static_cast<double>(line.size());
}

/// Lines along guides stay there when vertices are moved for the distance from the surface and
/// evened out, also where guides cross.
TEST(Remesh, EdgesRunAlongGuides) {
  SampleOptions sample;
  sample.faces = 8000;
  const PolyMesh mesh = make_sample(SampleKind::torus, sample);
  // Across both families of principal directions.
  const std::vector<Vec3> long_one = slanted({0, -0.5}, {1.2, 0.6});
  const std::vector<std::vector<Vec3>> one = {long_one};
  const std::vector<std::vector<Vec3>> crossing = {long_one, slanted({0.66, -0.7}, {0.54, 0.8})};
  for (const auto& lines : {one, crossing}) {
    RemeshOptions options;
    options.trace.vertices = 1500;
    options.measure = false;
    const PolyMesh result = remesh({mesh, {}, {lines, "guides"}, {}}, options).quads.mesh;
    EXPECT_NEAR(result.vertex_count(), 1500, 0.05 * 1500);
    for (const std::vector<Vec3>& line : lines) EXPECT_GT(share_on_edges(line, result), 0.9);
  }
}

}  // namespace
}  // namespace strake
