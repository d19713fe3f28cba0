#include "stages/fit/face_guard.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
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

/// Whoever takes back less than it takes, or nothing, as at the end of a line, hears of it again.
TEST(FaceGuard, CrossingsAreFoundUntilTheyAreGone) {
  PolyMesh sheets;
  QuadMesh quads;
  for (const Index sheet : {0, 1}) {
    for (const auto& [x, y] : {std::pair{0, 0}, {1, 0}, {1, 1}}) {
      sheets.positions.emplace_back(x, y, sheet);
    }
    sheets.add_face(std::array<Index, 3>{3 * sheet, 3 * sheet + 1, 3 * sheet + 2});
    for (const Vec3& b : {Vec3(0.8, 0.1, 0.1), Vec3(0.1, 0.8, 0.1), Vec3(0.1, 0.1, 0.8)}) {
      quads.mesh.positions.emplace_back(b[1] + b[2], b[2], sheet);
      quads.provenance.face.push_back(sheet);
      quads.provenance.barycentric.push_back({b[0], b[1], b[2]});
    }
    quads.mesh.add_face(std::array<Index, 3>{3 * sheet, 3 * sheet + 1, 3 * sheet + 2});
  }
  const TriMesh mesh = support::plain_tri_mesh(sheets);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, surface, quads);
  fitting::FaceGuard guard(quads.mesh, places);
  guard.set_start(places);
  const auto any_crosses = [&] { return std::ranges::count(guard.newly_crossing(places), 1) > 0; };
  EXPECT_FALSE(any_crosses());
  const fitting::VertexPlaces::State before = places.state(0);
  places.move(0, Vec3(0, 0, 3));
  ASSERT_GT((places.positions()[0] - before.position).norm(), 2);
  EXPECT_TRUE(any_crosses());
  EXPECT_TRUE(any_crosses());
  places.restore(0, before);
  EXPECT_FALSE(any_crosses());
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
