#include "stages/fit/divide_crossing.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"

namespace strake {
namespace {

std::size_t crossings(const PolyMesh& mesh) {
  return find_crossing_faces(mesh.positions, triangulate_faces(mesh)).size();
}

/// Two faces on either side of the bent crease A B C: one in the plane z = 0, one going down. Both
/// have the shorter diagonal A C, so both hold the triangle A B C.
PolyMesh bent_crease() {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, -0.2, 0}, {2, 0, 0}, {1, 2, 0}, {1, 0.3, -2}};
  mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  mesh.add_face(std::array<Index, 4>{2, 1, 0, 4});
  return mesh;
}

TEST(DivideCrossingFaces, AlongABentCrease) {
  PolyMesh mesh = bent_crease();
  ASSERT_EQ(crossings(mesh), 1u);
  EXPECT_EQ(fitting::divide_crossing_faces(mesh), 1);
  EXPECT_EQ(crossings(mesh), 0u);
  EXPECT_EQ(mesh.face_count(), 3);
  EXPECT_EQ(mesh.positions, bent_crease().positions);
  const PolyTopology topology = analyse(mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, analyse(bent_crease()).euler);
}

TEST(DivideCrossingFaces, LeavesAloneWhatNoDiagonalMends) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0},     {1, 0, 0},    {1, 1, 0},   {0, 1, 0},
                    {-1, 0.4, -1}, {2, 0.4, -1}, {2, 0.4, 1}, {-1, 0.4, 1}};
  mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  mesh.add_face(std::array<Index, 4>{4, 5, 6, 7});
  const PolyMesh before = mesh;
  ASSERT_EQ(crossings(mesh), 1u);
  EXPECT_EQ(fitting::divide_crossing_faces(mesh), 0);
  EXPECT_EQ(mesh.corners, before.corners);
}

TEST(DivideCrossingFaces, LeavesASoundMeshAlone) {
  SampleOptions options;
  options.faces = 2000;
  PolyMesh mesh = make_sample(SampleKind::part, options);
  const PolyMesh before = mesh;
  EXPECT_EQ(fitting::divide_crossing_faces(mesh), 0);
  EXPECT_EQ(mesh.corners, before.corners);
}

// The diagonal that would mend the crease is an edge already, of a third face: taking it would give
// that edge four faces.
TEST(DivideCrossingFaces, NeverMakesAnEdgeTwice) {
  PolyMesh mesh = bent_crease();
  mesh.positions.push_back({1, 1, 3});
  mesh.add_face(std::array<Index, 3>{1, 3, 5});
  mesh.positions.push_back({1, 0, -4});
  mesh.add_face(std::array<Index, 3>{1, 6, 4});
  ASSERT_GT(crossings(mesh), 0u);
  const PolyMesh before = mesh;
  fitting::divide_crossing_faces(mesh);
  EXPECT_EQ(analyse(mesh).nonmanifold_edges.count, 0);
  EXPECT_EQ(mesh.face_count(), before.face_count());
}

}  // namespace
}  // namespace strake
