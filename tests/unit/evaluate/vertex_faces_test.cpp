#include "common/geometry/poly_topology/vertex_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>

#include "common/geometry/poly_topology/poly_edges.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// Calls use(face, from, to) for every side of every face.
template <class Use>
void for_each_side(const PolyMesh& mesh, const Use& use) {
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) use(f, face[i], face[(i + 1) % face.size()]);
  }
}

TEST(VertexFaces, AreThoseThatNameTheVertex) {
  const PolyMesh mesh = shapes::square(3, 0);
  const VertexFaces around(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    std::vector<Index> faces;
    for_each_side(mesh, [&](Index f, Index from, Index) {
      if (from == v) faces.push_back(f);
    });
    EXPECT_TRUE(std::ranges::equal(around.faces(v), faces)) << v;
    ASSERT_EQ(around.corners(v).size(), faces.size());
    for (std::size_t i = 0; i < faces.size(); ++i) {
      const Index corner = around.corners(v)[i];
      EXPECT_EQ(mesh.corners[corner], v);
      EXPECT_TRUE(mesh.offsets[faces[i]] <= corner && corner < mesh.offsets[faces[i] + 1]);
    }
  }
}

TEST(VertexFaces, HaveSidesToTheNeighbours) {
  PolyMesh mesh = shapes::square(3, 0);
  mesh.positions.emplace_back(2, 2, 0);  // no face has it
  const VertexFaces around(mesh);
  std::vector<std::set<Index>> neighbours(mesh.positions.size());
  std::set<std::array<Index, 2>> sides;
  for_each_side(mesh, [&](Index f, Index from, Index to) {
    neighbours[from].insert(to);
    neighbours[to].insert(from);
    sides.insert({from, to});
    EXPECT_EQ(around.face_with_side(from, to), f);
  });
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_TRUE(std::ranges::equal(around.neighbours(v), neighbours[v])) << v;
    for (const Index w : neighbours[v]) {
      // No face has the side along the border that runs the other way.
      EXPECT_EQ(around.face_with_side(v, w) != kNone, sides.contains({v, w}));
    }
  }
  // The corners of a face across from each other are joined by no side.
  EXPECT_EQ(around.face_with_side(mesh.face(4)[0], mesh.face(4)[2]), kNone);
}

/// A side that several faces have, as where faces lie on each other.
TEST(VertexFaces, GivesTheLastFaceWithASide) {
  PolyMesh mesh;
  mesh.positions.resize(3);
  for (int i = 0; i < 2; ++i) mesh.add_face(std::array<Index, 3>{0, 1, 2});
  EXPECT_EQ(VertexFaces(mesh).face_with_side(1, 2), 1);
}

TEST(PolyEdges, HaveOppositeSides) {
  const PolyMesh mesh = shapes::square(3, 0);
  const PolyEdges edges = collect_edges(mesh);
  const std::vector<Index> opposite = opposite_sides(edges);
  ASSERT_EQ(opposite.size(), mesh.corners.size());
  Index alone = 0;
  for (Index c = 0; c < static_cast<Index>(opposite.size()); ++c) {
    if (opposite[c] == kNone) {
      ++alone;
      continue;
    }
    EXPECT_EQ(opposite[opposite[c]], c);
    EXPECT_EQ(mesh.corners[opposite[c]], mesh.corners[next_corner(mesh, edges, c)]);
    EXPECT_EQ(mesh.corners[next_corner(mesh, edges, opposite[c])], mesh.corners[c]);
  }
  EXPECT_EQ(alone, 12);  // around the square, three on each side
}

TEST(PolyEdges, OfThreeFacesHaveNoOppositeSides) {
  PolyMesh mesh;
  mesh.positions.resize(5);
  for (Index v = 2; v < 5; ++v) mesh.add_face(std::array<Index, 3>{0, 1, v});
  const std::vector<Index> opposite = opposite_sides(collect_edges(mesh));
  EXPECT_EQ(std::ranges::count(opposite, kNone), std::ssize(mesh.corners));
}

TEST(PolyMesh, GoesAroundFacesBothWays) {
  PolyMesh mesh;
  mesh.positions.resize(5);
  mesh.add_face(std::array<Index, 3>{0, 1, 2});
  mesh.add_face(std::array<Index, 4>{0, 2, 3, 4});
  EXPECT_EQ(mesh.next_corner(1, 3), 4);
  EXPECT_EQ(mesh.next_corner(1, 6), 3);
  EXPECT_EQ(mesh.previous_corner(1, 3), 6);
  EXPECT_EQ(mesh.previous_corner(1, 4), 3);
}

}  // namespace
}  // namespace strake
