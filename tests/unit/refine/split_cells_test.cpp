#include "stages/refine/split_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/way_split.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::grid;
using support::sides;
using support::total_area;

/// A grid of unit squares as faces, flat.
PolyMesh squares(Index n) {
  return grid(n, n, [](double, double) { return 0.0; }).quads.mesh;
}

/// Splits with marks in the middle of straight edges.
PolyMesh split(PolyMesh mesh, const std::vector<std::array<Index, 2>>& edges,
               std::vector<Index> chosen) {
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  for (const auto& [a, b] : edges) {
    marks.set(a, b, static_cast<Index>(positions.size()));
    positions.push_back((positions[a] + positions[b]) / 2);
  }
  std::vector<char> divide(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Index f : chosen) divide[f] = 1;
  return split_cells(mesh, divide, marks, 5, positions,
                     [&](Index a, Index b, const std::vector<Index>&) {
                       positions.push_back((positions[a] + positions[b]) / 2);
                       return static_cast<Index>(positions.size()) - 1;
                     });
}

// Vertices of squares(3): 0..3 in the first row, 4..7 in the second, and so on; face 4 is the
// middle one with the corners 5, 6, 10, 9.

TEST(SplitCells, OppositeMarksMakeTwoQuadsAndGiveTheNeighboursACorner) {
  const PolyMesh result = split(squares(3), {{5, 6}, {9, 10}}, {4});
  EXPECT_EQ(sides(result), (std::multiset<std::size_t>{4, 4, 4, 4, 4, 4, 4, 4, 5, 5}));
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
  EXPECT_NEAR(total_area(result), 1, 1e-12);
}

TEST(SplitCells, FourMarksMakeFourQuads) {
  const PolyMesh result = split(squares(3), {{5, 6}, {9, 10}, {5, 9}, {6, 10}}, {4});
  EXPECT_EQ(sides(result).count(4), 8U);
  EXPECT_EQ(sides(result).count(5), 4U);
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
}

TEST(SplitCells, MarksSideBySideMakeThreeQuads) {
  const PolyMesh result = split(squares(3), {{5, 6}, {6, 10}}, {4});
  EXPECT_EQ(sides(result).count(4), 9U);
  EXPECT_EQ(sides(result).count(5), 2U);
}

/// Cells at a boundary with teeth keep inside it, whichever way they are divided.
TEST(SplitCells, ChainsOfTeethMakeFacesInsideThem) {
  const PolyMesh mesh = squares(1);
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  std::vector<Index> chain;  // on the upper side, from right to left
  const Index teeth = 5;
  for (Index i = 1; i < 2 * teeth; ++i) {
    chain.push_back(static_cast<Index>(positions.size()));
    positions.emplace_back(1 - i / (2.0 * teeth), i % 2 == 0 ? 1.0 : 0.7, 0.0);
  }
  marks.set_chain(3, 2, chain);
  EXPECT_EQ(marks.at(3, 2), kNone);
  const PolyMesh result =
      split_cells(mesh, {0}, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
  EXPECT_EQ(result.vertex_count(), 4 + 2 * teeth - 1);
  // As all faces are turned up, none goes beyond the outline: five notches of height 0.3.
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_GT(newell_normal(result.positions, result.face(f)).z(), 0);
    EXPECT_LE(result.face(f).size(), 4U);
    EXPECT_FALSE(is_concave_face(result.positions, result.face(f)));
  }
  EXPECT_NEAR(total_area(result), 1 - 0.3 / 2, 1e-12);
}

/// The pentagon where a line ends: going on to the opposite edge leaves two quads.
TEST(SplitCells, ALineThatEndsInAPentagonGoesOn) {
  const PolyMesh first = split(squares(3), {{5, 6}, {9, 10}}, {4});  // 7 is a pentagon now
  Index pentagon = 0;
  for (Index f = 0; f < first.face_count(); ++f) {
    if (first.face(f).size() == 5 && newell_normal(first.positions, first.face(f)).z() > 0 &&
        first.positions[first.face(f)[0]].y() >= 2.0 / 3 - 1e-9) {
      pentagon = f;
    }
  }
  const PolyMesh second = split(first, {{13, 14}}, {pentagon});
  EXPECT_EQ(sides(second).count(5), 1U);
  EXPECT_EQ(sides(second).count(4), 10U);
}

TEST(SplitCells, ConcaveNeighboursAreDivided) {
  PolyMesh mesh = squares(3);
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  marks.set(5, 6, static_cast<Index>(positions.size()));
  positions.push_back((positions[5] + positions[6]) / 2 + Vec3(0, -0.1, 0));  // into face 1
  marks.set(9, 10, static_cast<Index>(positions.size()));
  positions.push_back((positions[9] + positions[10]) / 2 + Vec3(0, 0.1, 0));  // into face 7
  std::vector<char> divide(9, 0);
  divide[4] = 1;
  const PolyMesh result =
      split_cells(mesh, divide, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_FALSE(is_concave_face(result.positions, result.face(f))) << f;
  }
  EXPECT_NEAR(total_area(result), 1, 1e-12);
}

/// Two faces with two edges in common may both want the diagonal over these edges: only one gets
/// it.
TEST(SplitCells, NoDiagonalIsMadeTwice) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, -1.2, -1.2}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  mesh.add_face(std::array<Index, 4>{0, 4, 2, 1});
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  for (const Index v : {3, 4}) {
    marks.set(2, v, static_cast<Index>(positions.size()));
    positions.push_back(v == 3 ? Vec3(1.95, 0.95, 0) : Vec3(1.95, 0, 0.95));
  }
  const PolyMesh result =
      split_cells(mesh, {1, 1}, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  EXPECT_GT(result.face_count(), 3);
  EXPECT_TRUE(analyse(result).is_oriented_manifold()) << analyse(result).defects();
}

/// A ridge between two flat pieces is where to divide, wherever the middle is; a round arc is
/// divided in the middle, although a corner of its polygon may be a little farther from the chord.
TEST(WaySplit, IsAtARidgeOrInTheMiddle) {
  const WayPlace ridge = split_of_way({{0, 0, 0}, {1, 1, 0}, {4, 0, 0}});
  EXPECT_EQ(ridge.piece, 1U);
  EXPECT_EQ(ridge.share, 0);
  std::vector<Vec3> arc;
  for (int i = 0; i <= 7; ++i) {
    arc.push_back({std::cos(0.1 * i), std::sin(0.1 * i), 0});
  }
  const WayPlace middle = split_of_way(arc);
  EXPECT_EQ(middle.piece, 3U);
  EXPECT_NEAR(middle.share, 0.5, 1e-9);
  // A corner close to an end is no place to divide.
  EXPECT_EQ(split_of_way({{0, 0, 0}, {0, 0.2, 0}, {3, 0, 0}}).piece, 1U);
  EXPECT_GT(split_of_way({{0, 0, 0}, {0, 0.2, 0}, {3, 0, 0}}).share, 0.3);
}

TEST(WaySplit, HeightIsThatOverTheChord) {
  const std::vector<Vec3> way = {{0, 0, 0}, {1, 0, 0},   {1.5, 1, 0}, {2, 0, 0},
                                 {3, 0, 0}, {4, 0.1, 0}, {5, 0, 0}};
  EXPECT_EQ(height_of_way(way), 1);
  EXPECT_EQ(height_of_way({}), 0);
}

}  // namespace
}  // namespace strake
