#include "stages/fit/vertex_places.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

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

/// What an edge of the result cuts off the boundary, in the order of its face.
TEST(VertexPlaces, KnowTheBoundaryBetweenThem) {
  for (const std::uint8_t has_corners : {std::uint8_t{0}, std::uint8_t{1}}) {
    const OnTheBoundary c(has_corners);
    const SurfaceDistance surface(c.mesh.positions, c.mesh.faces);
    const fitting::VertexPlaces places(c.mesh, surface, c.quads);
    EXPECT_EQ(places.boundary_between(2, 0), std::vector<Vec3>{c.triangle.positions[0]});
  }
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

/// Where another part faces the same way and is nearer, labels and colours are not to come from it.
TEST(VertexPlaces, HaveTheirFeetOnTheirOwnComponent) {
  PolyMesh sheets;
  for (const double z : {0.0, 0.1}) {
    const auto first = static_cast<Index>(sheets.positions.size());
    sheets.positions.insert(sheets.positions.end(),
                            {Vec3(-3, -3, z), Vec3(3, -3, z), Vec3(0, 3, z)});
    sheets.add_face(std::array<Index, 3>{first, first + 1, first + 2});
  }
  const TriMesh mesh = support::plain_tri_mesh(sheets);
  QuadMesh quads;
  quads.mesh.positions = {Vec3(0, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 0.5, 0)};
  quads.mesh.add_face(std::array<Index, 3>{0, 1, 2});
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  for (const Vec3& p : quads.mesh.positions) {
    const ClosestPoint foot = surface.closest(p);
    quads.provenance.face.push_back(foot.triangle);
    quads.provenance.barycentric.push_back(foot.barycentric);
  }
  fitting::VertexPlaces places(mesh, surface, quads);
  ASSERT_TRUE(places.is_free(0));
  places.move(0, Vec3(0, 0, 0.09));
  places.update_feet();
  EXPECT_NEAR(places.height(0), 0.09, 1e-15);
  places.store(quads);
  EXPECT_EQ(quads.provenance.face[0], 0);
}

/// Vertices in the middle of the teeth of a saw slide along it there; one on a flank stays on that.
TEST(VertexPlaces, FollowTheCourseOfASaw) {
  constexpr Index kTeeth = 60;
  constexpr double kHeight = 0.02;
  constexpr Index kCells = 20;
  PolyMesh ring;
  for (const double radius : {1.0, 2.0}) {
    for (Index i = 0; i < 2 * kTeeth; ++i) {
      const double angle = M_PI * i / kTeeth;
      const double tooth = radius < 2 ? 0 : (i % 2 == 0 ? kHeight : -kHeight);
      ring.positions.emplace_back((radius + tooth) * std::cos(angle),
                                  (radius + tooth) * std::sin(angle), 0);
    }
  }
  for (Index i = 0; i < 2 * kTeeth; ++i) {
    const Index next = (i + 1) % (2 * kTeeth);
    ring.add_face(std::array<Index, 3>{i, 2 * kTeeth + i, 2 * kTeeth + next});
    ring.add_face(std::array<Index, 3>{i, 2 * kTeeth + next, next});
  }
  const TriMesh mesh = support::plain_tri_mesh(ring);
  QuadMesh quads;
  for (const double radius : {1.0, 2.0}) {
    for (Index c = 0; c < kCells; ++c) {
      const Index i = c * 2 * kTeeth / kCells;  // a tip, or beside the first face's inner corner
      const double angle = M_PI * i / kTeeth;
      quads.mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
      quads.provenance.face.push_back(2 * i);
      quads.provenance.barycentric.push_back(radius < 2 ? std::array<double, 3>{1, 0, 0}
                                                        : std::array<double, 3>{0, 1, 0});
    }
  }
  for (Index c = 0; c < kCells; ++c) {
    const Index next = (c + 1) % kCells;
    quads.mesh.add_face(std::array<Index, 4>{c, kCells + c, kCells + next, next});
  }
  quads.mesh.positions[kCells] = ring.positions[2 * kTeeth];  // on its tip
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, surface, quads);
  const std::vector<fitting::VertexPlaces::State> start = places.states();
  for (double way = -0.5; way < 0.5; way += 0.013) {
    for (Index v = kCells + 1; v < 2 * kCells; ++v) {
      places.restore(v, start[v]);
      places.move(v, way * Vec3(0, 0, 1).cross(quads.mesh.positions[v]).normalized());
      // The mean of an arc is a little further in.
      EXPECT_NEAR(places.positions()[v].norm(), 2, kHeight / 2);
    }
  }
  places.move(kCells, Vec3::Zero());
  EXPECT_EQ(places.positions()[kCells], ring.positions[2 * kTeeth]);
}

}  // namespace
}  // namespace strake
