#include "stages/refine/flat_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/merge_places.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

/// Above the x axis a face with the side A B, below it two that meet in M on that side, and the
/// triangle A B M without area between them.
PolyMesh half_cut(bool is_quad_above) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, -1, 0}, {2, 2, 0}, {0, 2, 0}};
  constexpr Index kA = 0;
  constexpr Index kB = 1;
  constexpr Index kM = 2;
  if (is_quad_above) {
    mesh.add_face(std::array<Index, 4>{kA, kB, 4, 5});
  } else {
    mesh.add_face(std::array<Index, 3>{kA, kB, 4});
    mesh.add_face(std::array<Index, 3>{kA, 4, 5});
  }
  mesh.add_face(std::array<Index, 3>{kB, kA, kM});
  mesh.add_face(std::array<Index, 3>{kM, kA, 3});
  mesh.add_face(std::array<Index, 3>{kB, kM, 3});
  return mesh;
}

TEST(FlatFaces, EdgesOfTrianglesWithoutAreaAreTurned) {
  for (const bool is_quad_above : {false, true}) {
    const PolyMesh faces = half_cut(is_quad_above);
    const support::Case c = support::on_triangles(faces, triangulate_faces(faces));
    ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 1e-3);
    QuadMesh quads = c.quads;
    mend_flat_faces_within(proof, quads);
    EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
    double area = 0;
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      const double own = newell_normal(quads.mesh.positions, quads.mesh.face(f)).z() / 2;
      EXPECT_GT(own, 0.1);
      area += own;
    }
    EXPECT_NEAR(area, 6.5, 1e-12);
    EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
    EXPECT_EQ(analyse(quads.mesh).boundary_loops, 1);
  }
}

/// The quad above is cut the other way where the turned edge, M to 4, belongs to other faces.
TEST(FlatFaces, AnEdgeThatIsThereIsNotMadeAgain) {
  const PolyMesh faces = half_cut(true);
  PolyMesh folded;
  folded.positions = faces.positions;
  for (Index f = 0; f < 3; ++f) folded.add_face(faces.face(f));
  folded.add_face(std::array<Index, 3>{1, 2, 4});
  const support::Case c = support::on_triangles(folded, triangulate_faces(folded));
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 1e-3);
  QuadMesh quads = c.quads;
  mend_flat_faces_within(proof, quads);
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    EXPECT_GT(newell_normal(quads.mesh.positions, quads.mesh.face(f)).norm() / 2, 0.1);
  }
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, analyse(folded).euler);
}

/// A grid of 4 x 4 quads with a quad folded onto itself in a slit along two of its edges, around a
/// vertex that is there twice.
QuadMesh slit(bool at_boundary) {
  QuadMesh quads = support::grid(8, 4, [](double, double) { return 0.0; }).quads;
  const Index row = 5;
  const Index u = at_boundary ? row + 1 : 2 * row + 2;
  const Index w = quads.mesh.vertex_count();
  quads.mesh.positions.push_back(Vec3(quads.mesh.positions[u]));
  quads.provenance.face.push_back(Index{quads.provenance.face[u]});
  quads.provenance.barycentric.push_back(std::array(quads.provenance.barycentric[u]));
  quads.provenance.lines.push_back({kNone, kNone});
  const double y = quads.mesh.positions[u].y();
  PolyMesh faces;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    std::vector<Index> corners;
    double height = 0;
    for (const Index v : quads.mesh.face(f)) {
      corners.push_back(v);
      height += quads.mesh.positions[v].y() / 4;
    }
    if (height < y) std::ranges::replace(corners, u, w);
    faces.add_face(corners);
  }
  faces.add_face(std::array<Index, 4>{u, u - 1, w, u + 1});
  quads.mesh.corners = faces.corners;
  quads.mesh.offsets = faces.offsets;
  return quads;
}

TEST(MergePlaces, ClosesASlit) {
  QuadMesh quads = slit(false);
  ASSERT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(merge_places(quads), 1);
  EXPECT_EQ(quads.mesh.vertex_count(), 25);
  EXPECT_EQ(quads.provenance.face.size(), 25u);
  EXPECT_EQ(quads.mesh.face_count(), 16);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, 1);
  for (Index f = 0; f < 16; ++f) {
    EXPECT_NEAR(newell_normal(quads.mesh.positions, quads.mesh.face(f)).z() / 2, 1.0 / 16, 1e-12);
  }
}

TEST(MergePlaces, MakesTrianglesOfQuadsWithASideOfNoLength) {
  QuadMesh quads = support::grid(8, 4, [](double, double) { return 0.0; }).quads;
  quads.mesh.positions[12] = quads.mesh.positions[13];
  EXPECT_EQ(merge_places(quads), 1);
  EXPECT_EQ(quads.mesh.face_count(), 16);
  Index triangles = 0;
  for (Index f = 0; f < 16; ++f) triangles += quads.mesh.face(f).size() == 3 ? 1 : 0;
  EXPECT_EQ(triangles, 2);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, 1);
}

/// Two vertices of an edge at the same place are merged also where all faces have an area.
TEST(FlatFaces, SidesOfNoLengthGo) {
  const support::Case c = support::grid(8, 4, [](double, double) { return 0.0; });
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 1e-3);
  QuadMesh quads = c.quads;
  quads.mesh.positions[12] = quads.mesh.positions[13];
  mend_flat_faces_within(proof, quads);
  EXPECT_EQ(quads.mesh.vertex_count(), 24);
  EXPECT_EQ(quads.mesh.face_count(), 16);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
}

/// An edge from the boundary inwards goes to the boundary; one along it stays.
TEST(MergePlaces, LeavesTheBoundaryItsVertices) {
  QuadMesh quads = support::grid(8, 4, [](double, double) { return 0.0; }).quads;
  quads.mesh.positions[7] = quads.mesh.positions[2];
  const Index foot = quads.provenance.face[2];
  EXPECT_EQ(merge_places(quads), 1);
  EXPECT_EQ(quads.mesh.face_count(), 16);
  EXPECT_EQ(quads.provenance.face[2], foot);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, 1);
  QuadMesh along = support::grid(8, 4, [](double, double) { return 0.0; }).quads;
  along.mesh.positions[2] = along.mesh.positions[1];
  EXPECT_EQ(merge_places(along), 0);
}

/// Two flat triangles with one vertex of four faces: each could go, both would leave it two faces.
TEST(MergePlaces, LeavesAVertexItsFacesWhereTwoPairsAreBesideIt) {
  QuadMesh quads;
  // 0 in the middle of a ring 1 .. 6, of which 1 and 2 are at one place, and 4 and 5.
  quads.mesh.positions = {{0, 0, 0},   {1, 1, 0},  {1, 1, 0},  {-1, 1, 0}, {-1, -1, 0},
                          {-1, -1, 0}, {1, -1, 0}, {3, 2, 0},  {-2, 2, 0}, {-3, -2, 0},
                          {2, -2, 0},  {2, 3, 0},  {-2, -3, 0}};
  quads.mesh.add_face(std::array<Index, 3>{0, 1, 2});
  quads.mesh.add_face(std::array<Index, 4>{0, 2, 3, 4});
  quads.mesh.add_face(std::array<Index, 3>{0, 4, 5});
  quads.mesh.add_face(std::array<Index, 4>{0, 5, 6, 1});
  quads.mesh.add_face(std::array<Index, 4>{2, 1, 7, 11});
  quads.mesh.add_face(std::array<Index, 4>{2, 11, 8, 3});
  quads.mesh.add_face(std::array<Index, 4>{3, 8, 9, 4});
  quads.mesh.add_face(std::array<Index, 4>{4, 9, 12, 5});
  quads.mesh.add_face(std::array<Index, 4>{5, 12, 10, 6});
  quads.mesh.add_face(std::array<Index, 4>{6, 10, 7, 1});
  quads.provenance.face.assign(13, 0);
  quads.provenance.barycentric.assign(13, {1, 0, 0});
  quads.provenance.lines.assign(13, {kNone, kNone});
  ASSERT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(merge_places(quads), 1);
  Index faces = 0;
  for (const Index v : quads.mesh.corners) faces += v == 0 ? 1 : 0;
  EXPECT_EQ(faces, 3);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
}

/// Beside a slit that begins at the boundary a vertex would be left with two faces.
TEST(MergePlaces, LeavesVerticesTheirFaces) {
  QuadMesh quads = slit(true);
  const std::vector<Index> before = quads.mesh.corners;
  EXPECT_EQ(merge_places(quads), 0);
  EXPECT_EQ(quads.mesh.corners, before);
}

/// A tube of three sides with two vertices of a ring at one place is a pinched one.
TEST(MergePlaces, LeavesWhatWouldBeNoSurface) {
  QuadMesh quads;
  for (int ring = 0; ring < 4; ++ring) {
    for (int i = 0; i < 3; ++i) {
      const double turn = 2 * M_PI * i / 3;
      quads.mesh.positions.push_back({std::cos(turn), std::sin(turn), double(ring)});
      quads.provenance.face.push_back(0);
      quads.provenance.barycentric.push_back({1, 0, 0});
      quads.provenance.lines.push_back({kNone, kNone});
    }
  }
  const auto at = [](Index ring, Index i) { return 3 * ring + i % 3; };
  for (Index ring = 0; ring < 3; ++ring) {
    for (Index i = 0; i < 3; ++i) {
      quads.mesh.add_face(
          std::array{at(ring, i), at(ring, i + 1), at(ring + 1, i + 1), at(ring + 1, i)});
    }
  }
  quads.mesh.positions[at(1, 0)] = quads.mesh.positions[at(1, 1)];
  const std::vector<Index> before = quads.mesh.corners;
  EXPECT_EQ(merge_places(quads), 0);
  EXPECT_EQ(quads.mesh.corners, before);
}

/// Four points of a line, between faces that have an area.
TEST(FlatFaces, QuadsWithoutAreaGoToTheFacesAround) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {3, 0, 0}, {1, 0, 0}, {2, 3, 0}, {1, -3, 0}, {3, -3, 0}};
  mesh.add_face(std::array<Index, 3>{0, 1, 4});
  mesh.add_face(std::array<Index, 4>{1, 0, 3, 2});
  mesh.add_face(std::array<Index, 3>{3, 0, 5});
  mesh.add_face(std::array<Index, 4>{2, 3, 5, 6});
  mesh.add_face(std::array<Index, 3>{1, 2, 6});
  const support::Case c = support::on_triangles(mesh, triangulate_faces(mesh));
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 1e-3);
  QuadMesh quads = c.quads;
  mend_flat_faces_within(proof, quads);
  double area = 0;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const double own = newell_normal(quads.mesh.positions, quads.mesh.face(f)).z() / 2;
    EXPECT_GT(own, 0.1);
    area += own;
  }
  EXPECT_NEAR(area, 6 + 9, 1e-12);
  EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
}

}  // namespace
}  // namespace strake
