#include "stages/fit/vertex_places.h"

#include <gtest/gtest.h>

#include <array>

#include "common/geometry/surface_distance/surface_distance.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A vertex on the boundary moves along it as far as a corner, however far it should go.
TEST(VertexPlaces, StopAtTheEndOfTheirLine) {
  PolyMesh triangle;
  triangle.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  triangle.add_face(std::array<Index, 3>{0, 1, 2});
  TriMesh mesh = support::plain_tri_mesh(triangle);
  mesh.is_corner.assign(3, 1);
  QuadMesh quads;
  quads.mesh = triangle;
  quads.mesh.positions[0] = Vec3(0.4, 0, 0);
  quads.provenance.face = {0, 0, 0};
  quads.provenance.barycentric = {{0.6, 0.4, 0}, {0, 1, 0}, {0, 0, 1}};
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, surface, quads);
  places.move(0, Vec3(0.3, 5, 5));
  EXPECT_LT((places.positions()[0] - Vec3(0.7, 0, 0)).norm(), 1e-15);
  places.move(0, Vec3(10, 0, 0));
  EXPECT_EQ(places.positions()[0], triangle.positions[1]);
  places.move(0, Vec3(-20, 0, 0));
  EXPECT_EQ(places.positions()[0], triangle.positions[0]);
}

}  // namespace
}  // namespace strake
