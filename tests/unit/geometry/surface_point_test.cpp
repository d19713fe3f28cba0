#include "common/geometry/surface_point.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

const auto kEverySide = [](Index) { return true; };

/// Two faces of a square, with the diagonal between them.
TriMesh square() {
  PolyMesh faces;
  faces.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  faces.add_face(std::array<Index, 3>{0, 1, 2});
  faces.add_face(std::array<Index, 3>{0, 2, 3});
  return support::plain_tri_mesh(faces);
}

TEST(SurfacePoint, IsInsideAFaceOnAnEdgeOrAtAVertex) {
  const SurfacePoint inside{2, {0.2, 0.3, 0.5}};
  EXPECT_EQ(corner_at(inside), kNone);
  EXPECT_EQ(edge_at(inside, kEverySide), kNone);
  for (Index h = 6; h < 9; ++h) {
    const SurfacePoint on_edge = point_along(h, 0.25);
    EXPECT_EQ(corner_at(on_edge), kNone);
    EXPECT_EQ(edge_at(on_edge, kEverySide), h);
    EXPECT_EQ(edge_at(on_edge, [&](Index side) { return side != h; }), kNone);
    EXPECT_EQ(share_along(on_edge, h), 0.25);
    EXPECT_EQ(corner_at(point_along(h, 0)), h);
    EXPECT_EQ(corner_at(point_along(h, 1)), TriMesh::next(h));
  }
}

/// An end of an edge is on that, and on the edge that ends there.
TEST(SurfacePoint, OfAVertexIsOnBothEdgesThere) {
  const SurfacePoint vertex = point_along(4, 0);
  EXPECT_TRUE(is_on_edge(vertex, 4));
  EXPECT_TRUE(is_on_edge(vertex, 3));
  EXPECT_FALSE(is_on_edge(vertex, 5));
}

/// What rounding may leave, a hundredth of the tolerance, changes nothing; ten times that does.
TEST(SurfacePoint, IsWhereItIsUpToATolerance) {
  const double little = 0.01 * kOnEdge;
  EXPECT_EQ(corner_at({0, {1 - 2 * little, little, little}}), 0);
  EXPECT_EQ(edge_at({0, {0.5 - little, 0.5, little}}, kEverySide), 0);
  const double much = 10 * kOnEdge;
  EXPECT_EQ(corner_at({0, {1 - 2 * much, much, much}}), kNone);
  EXPECT_EQ(edge_at({0, {0.5 - much, 0.5, much}}, kEverySide), kNone);
}

TEST(SurfacePoint, AlongAnEdgeIsTheSamePlaceInBothFaces) {
  const TriMesh mesh = square();
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Vec3& from = mesh.positions[mesh.from(h)];
    const Vec3& to = mesh.positions[mesh.to(h)];
    // A quarter is exact, and so are sums of coordinates 0 and 1.
    EXPECT_EQ(place_of(mesh, point_along(h, 0.25)), from + 0.25 * (to - from));
    if (mesh.is_boundary(h)) continue;
    EXPECT_EQ(place_of(mesh, point_along(h, 0.25)),
              place_of(mesh, point_along(mesh.twin[h], 0.75)));
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_EQ(place_of(mesh, point_at_vertex(mesh, v)), mesh.positions[v]);
  }
}

TEST(SurfacePoint, IsKeptAsAFoot) {
  VertexProvenance provenance;
  add_foot(provenance, point_along(7, 0.25));
  add_foot(provenance, {});
  set_foot(provenance, 1, point_along(3, 0.5));
  EXPECT_EQ(foot_of(provenance, 0).face, 2);
  EXPECT_EQ(foot_of(provenance, 0).barycentric, (std::array<double, 3>{0, 0.75, 0.25}));
  EXPECT_EQ(foot_of(provenance, 1).face, 1);
  EXPECT_EQ(foot_of(provenance, 1).barycentric, (std::array<double, 3>{0.5, 0.5, 0}));
  EXPECT_EQ(provenance.lines.size(), 2u);
}

}  // namespace
}  // namespace strake
