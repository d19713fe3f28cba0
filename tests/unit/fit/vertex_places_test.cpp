#include "stages/fit/vertex_places.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>

#include "common/geometry/surface_distance/surface_distance.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A triangle, with a result whose vertex 0 is on the way to vertex 1.
struct OnTheBoundary {
  PolyMesh triangle;
  TriMesh mesh;
  QuadMesh quads;

  explicit OnTheBoundary(std::uint8_t has_corners) {
    triangle.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    triangle.add_face(std::array<Index, 3>{0, 1, 2});
    mesh = support::plain_tri_mesh(triangle);
    mesh.is_corner.assign(3, has_corners);
    quads.mesh = triangle;
    quads.mesh.positions[0] = Vec3(0.4, 0, 0);
    quads.provenance.face = {0, 0, 0};
    quads.provenance.barycentric = {{0.6, 0.4, 0}, {0, 1, 0}, {0, 0, 1}};
  }
};

/// A vertex on the boundary moves along it as far as a corner, however far it should go.
TEST(VertexPlaces, StopAtTheEndOfTheirLine) {
  const OnTheBoundary c(1);
  const SurfaceDistance surface(c.mesh.positions, c.mesh.faces);
  fitting::VertexPlaces places(c.mesh, surface, c.quads);
  places.move(0, Vec3(0.3, 5, 5));
  EXPECT_LT((places.positions()[0] - Vec3(0.7, 0, 0)).norm(), 1e-15);
  places.move(0, Vec3(10, 0, 0));
  EXPECT_EQ(places.positions()[0], c.triangle.positions[1]);
  places.move(0, Vec3(-20, 0, 0));
  EXPECT_EQ(places.positions()[0], c.triangle.positions[0]);
}

/// Without corners it goes around, but not for ever: so often that its way does not get shorter.
TEST(VertexPlaces, GoAroundAtMostOnce) {
  const OnTheBoundary c(0);
  const SurfaceDistance surface(c.mesh.positions, c.mesh.faces);
  fitting::VertexPlaces places(c.mesh, surface, c.quads);
  places.move(0, Vec3(1.1, 0, 0));
  EXPECT_LT((places.positions()[0] - Vec3(1 - std::sqrt(0.125), std::sqrt(0.125), 0)).norm(),
            1e-15);
  fitting::VertexPlaces others(c.mesh, surface, c.quads);
  others.move(0, Vec3(1e300, 0, 0));
  EXPECT_EQ(others.positions()[0], c.triangle.positions[0]);
  others.restore(0, fitting::VertexPlaces(c.mesh, surface, c.quads).state(0));
  others.move(0, Vec3(-1e300, 0, 0));
  EXPECT_EQ(others.positions()[0], c.triangle.positions[1]);
}

/// The field of a coarser mesh has the normals of the surface that the mesh stands for.
TEST(VertexPlaces, HaveTheNormalsOfTheField) {
  const OnTheBoundary c(1);
  const SurfaceDistance surface(c.mesh.positions, c.mesh.faces);
  PrincipalField field;
  field.normal = {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)};
  const fitting::VertexPlaces places(c.mesh, surface, c.quads, &field);
  EXPECT_LT((places.normal(0) - Vec3(0.6, 0.4, 0).normalized()).norm(), 1e-15);
  EXPECT_LT((fitting::VertexPlaces(c.mesh, surface, c.quads).normal(0) - Vec3(0, 0, 1)).norm(),
            1e-15);
}

}  // namespace
}  // namespace strake
