#include "stages/mesh/sharp_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/poly_topology/poly_topology.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

constexpr Index kFine = 40;  ///< squares of the surface along each side
constexpr Index kCells = 5;  ///< of the result

/// A cone over the unit square whose tip is at a vertex of the surface, in its squares from x = 0
/// and y = 0; flat where that is farther away than `reach`.
support::Case cone(Index x, Index y, double reach = 2, Index cells = kCells) {
  const Vec2 tip(double(x) / kFine, double(y) / kFine);
  support::Case c = support::grid(kFine, cells, [&](double px, double py) {
    return std::max(0.0, reach - (Vec2(px, py) - tip).norm());
  });
  c.mesh.is_corner[y * (kFine + 1) + x] = 1;
  return c;
}

Index meet(const support::Case& c, bool may_add, QuadMesh& quads) {
  quads = c.quads;
  return meet_sharp_points(c.mesh, may_add, quads);
}

/// Vertices that are where the surface has its highest one.
std::ptrdiff_t at_tip(const support::Case& c, const QuadMesh& quads) {
  const auto highest = std::ranges::max_element(
      c.mesh.positions, [](const Vec3& a, const Vec3& b) { return a.z() < b.z(); });
  return std::ranges::count(quads.mesh.positions, *highest + c.mesh.origin);
}

// The tip is a quarter of a cell away from a vertex.
TEST(MeetSharpPoints, MovesAVertexThatIsNear) {
  const support::Case c = cone(18, 16);
  QuadMesh quads;
  EXPECT_EQ(meet(c, true, quads), 1);
  EXPECT_EQ(at_tip(c, quads), 1);
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
  EXPECT_EQ(quads.mesh.vertex_count(), c.quads.mesh.vertex_count());
}

// A block in the next cell makes the vertex beside the tip a bad one, whether it is moved or not.
TEST(MeetSharpPoints, PutsNoVertexBesideAnother) {
  support::Case c = support::grid(kFine, 4, [&](double x, double y) {
    const bool is_on_block = std::max(std::abs(x - 0.375), std::abs(y - 0.375)) < 0.11;
    return 2 - (Vec2(x, y) - Vec2(21.0 / kFine, 0.5)).norm() + (is_on_block ? 2.0 : 0.0);
  });
  const Index tip = 20 * (kFine + 1) + 21;
  c.mesh.is_corner[tip] = 1;
  QuadMesh quads;
  EXPECT_EQ(meet(c, true, quads), 1);
  EXPECT_EQ(quads.mesh.vertex_count(), c.quads.mesh.vertex_count());
  const Vec3 place = c.mesh.positions[tip] + c.mesh.origin;
  std::vector<double> distances;
  for (const Vec3& p : quads.mesh.positions) distances.push_back((p - place).norm());
  std::ranges::sort(distances);
  EXPECT_EQ(distances[0], 0);
  EXPECT_GT(distances[1], 0.2);
}

// The corners of the cell are on the boundary.
TEST(MeetSharpPoints, PutsAVertexIntoACell) {
  const support::Case c = cone(20, 20, 2, 1);
  QuadMesh quads;
  EXPECT_EQ(meet(c, true, quads), 1);
  EXPECT_EQ(at_tip(c, quads), 1);
  EXPECT_EQ(quads.mesh.vertex_count(), 5);
  const PolyTopology topology = analyse(quads.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, 1);
  EXPECT_EQ(quads.mesh.face_count(), 3);
  EXPECT_EQ(topology.triangles, 2);
  ASSERT_EQ(quads.provenance.face.size(), quads.mesh.positions.size());
  EXPECT_EQ(quads.provenance.lines.size(), quads.mesh.positions.size());
}

TEST(MeetSharpPoints, AddsNothingWhereFacesAreToStayAsTheyAre) {
  const support::Case c = cone(20, 20, 2, 1);
  QuadMesh quads;
  EXPECT_EQ(meet(c, false, quads), 0);
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

// Edges from its tip to vertices of cells would be far from the flat around it.
TEST(MeetSharpPoints, LeavesThornsAlone) {
  for (const Index x : {18, 20}) {
    const support::Case c = cone(x, 20, 0.04);
    QuadMesh quads;
    EXPECT_EQ(meet(c, true, quads), 0);
    EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
    EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
  }
}

// A vertex of the outline is the nearest one.
TEST(MeetSharpPoints, LeavesVerticesOnLinesWhereTheyAre) {
  const support::Case c = cone(16, 1);
  QuadMesh quads;
  meet(c, false, quads);
  EXPECT_EQ(quads.mesh.positions[2], c.quads.mesh.positions[2]);
}

}  // namespace
}  // namespace strake
