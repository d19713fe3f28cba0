#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "strake/chain/remesh.h"
#include "tests/unit/chain/results.h"

namespace strake {
namespace {

constexpr int kColumns = 120;  ///< of triangles around the tube
constexpr int kRows = 100;
constexpr double kRow = 0.03;
constexpr double kTop = kRows * kRow;  ///< height of the last whole row

/// A tube of radius 1 that stands on a plain ring and ends above in a saw: of the last row of
/// triangles every other one is cut away, as where a scan was cropped.
PolyMesh sawn_tube() {
  PolyMesh mesh;
  for (int j = 0; j <= kRows + 1; ++j) {
    for (int i = 0; i < kColumns; ++i) {
      const double angle = 2 * M_PI * (i + 0.5 * j) / kColumns;
      mesh.positions.emplace_back(std::cos(angle), std::sin(angle), kRow * j);
    }
  }
  const auto at = [](Index i, Index j) { return j * kColumns + i % kColumns; };
  for (Index j = 0; j <= kRows; ++j) {
    for (Index i = 0; i < kColumns; ++i) {
      mesh.add_face(std::array<Index, 3>{at(i, j), at(i + 1, j), at(i, j + 1)});
      if (j == kRows) continue;
      mesh.add_face(std::array<Index, 3>{at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  }
  return mesh;
}

/// Heights of the vertices on one of the two boundaries of a result.
std::vector<double> heights_on_boundary(const PolyMesh& mesh, bool above) {
  std::vector<double> heights;
  const PolyEdges edges = collect_edges(mesh);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (edges.sides_of(e).size() != 1) continue;
    // As many edges as vertices.
    const double z = mesh.positions[edges.vertices[e][0]].z();
    if ((z > kTop / 2) == above) heights.push_back(z);
  }
  return heights;
}

// The saw has 120 teeth, half as wide as cells or less: it took two to three vertices for each.
TEST(Remesh, SawsOfTrianglesAreBorders) {
  for (const int wanted : {300, 500}) {
    RemeshOptions options;
    options.trace.vertices = wanted;
    options.measure = false;
    const PolyMesh result = remesh({sawn_tube(), {}, {}, {}}, options).quads.mesh;
    const std::vector<double> plain = heights_on_boundary(result, false);
    const std::vector<double> sawn = heights_on_boundary(result, true);
    EXPECT_LT(static_cast<double>(sawn.size()), 1.5 * static_cast<double>(plain.size())) << wanted;
    // In the middle of teeth, but for those that cells which are divided get.
    const auto off = std::ranges::count_if(
        sawn, [](double z) { return std::abs(z - (kTop + kRow / 2)) > kRow / 10; });
    EXPECT_LT(10 * off, static_cast<std::ptrdiff_t>(sawn.size())) << wanted;
    for (const double z : plain) EXPECT_NEAR(z, 0, 1e-12) << wanted;
    EXPECT_EQ(crossings(result), 0u);
  }
}

// Teeth that are higher over their middle than the tolerance are all there; where half of that is
// more than theirs none has to be.
TEST(Remesh, SawsCountForATolerance) {
  const PolyMesh tube = sawn_tube();
  const auto vertices_on_saw = [&](double tolerance) {
    RemeshOptions options;
    options.trace.tolerance = Length{tolerance, false};
    const RemeshResult result = remesh({tube, {}, {}, {}}, options);
    EXPECT_LT(largest_distance(result), tolerance);
    return heights_on_boundary(result.quads.mesh, true).size();
  };
  EXPECT_GE(vertices_on_saw(0.2 * kRow), static_cast<std::size_t>(2 * kColumns));
  EXPECT_LT(vertices_on_saw(1.2 * kRow), static_cast<std::size_t>(kColumns));
}

}  // namespace
}  // namespace strake
