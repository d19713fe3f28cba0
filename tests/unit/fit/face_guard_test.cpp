#include "stages/fit/face_guard.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/surface_distance/surface_distance.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// The unit square, with its corners.
TriMesh square() {
  PolyMesh square;
  square.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  square.add_face(std::array<Index, 3>{0, 1, 2});
  square.add_face(std::array<Index, 3>{0, 2, 3});
  TriMesh mesh = support::plain_tri_mesh(square);
  mesh.is_corner.assign(4, 1);
  return mesh;
}

/// A quad on it whose first vertex lies 0.4 along the first side.
/// \param off  of the second vertex, from the corner where that side ends
QuadMesh quad_on_square(double off) {
  QuadMesh quads;
  quads.mesh.positions = {Vec3(0.4, 0, 0), Vec3(1, off, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  quads.mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  quads.provenance.face = {0, 0, 0, 1};
  quads.provenance.barycentric = {{0.6, 0.4, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 1}};
  return quads;
}

/// A vertex that slides to the corner where its line ends, and where another one is up to rounding,
/// leaves angles of any size.
TEST(FaceGuard, SidesKeepALength) {
  const TriMesh mesh = square();
  const QuadMesh quads = quad_on_square(1e-17);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, surface, quads);
  fitting::FaceGuard guard(quads.mesh, places);
  guard.set_start(places);
  places.move(0, Vec3(0.3, 0, 0));
  EXPECT_FALSE(guard.is_spoilt(places, 0));
  places.move(0, Vec3(10, 0, 0));
  ASSERT_EQ(places.positions()[0], mesh.positions[1]);
  EXPECT_TRUE(guard.is_spoilt(places, 0));
  // Where that was so from the start it may stay.
  guard.set_start(places);
  EXPECT_FALSE(guard.is_spoilt(places, 0));
}

/// A quarter of the way in each round would be all but all of it.
TEST(FaceGuard, VerticesDoNotSlideOntoEachOther) {
  const TriMesh mesh = square();
  const QuadMesh quads = quad_on_square(0);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, surface, quads);
  fitting::FaceGuard guard(quads.mesh, places);
  const auto shortest_over_mean = [&] {
    const std::vector<Vec3>& p = places.positions();
    const double shortest = (p[1] - p[0]).norm();
    return 4 * shortest / (shortest + 2 + (p[3] - p[0]).norm());
  };
  for (int round = 0; round < 40; ++round) {
    guard.set_start(places);
    const fitting::VertexPlaces::State before = places.state(0);
    places.move(0, 0.25 * (places.positions()[1] - places.positions()[0]));
    if (!guard.is_spoilt(places, 0)) continue;
    EXPECT_EQ(guard.spoilt(places), (std::vector<std::uint8_t>{1, 1, 0, 0})) << "its ends alone";
    places.restore(0, before);
  }
  EXPECT_GT(shortest_over_mean(), 0.05);
  EXPECT_LT(shortest_over_mean(), 0.05 / 0.7) << "it may come that near";
}

}  // namespace
}  // namespace strake
