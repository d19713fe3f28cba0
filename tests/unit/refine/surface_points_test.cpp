#include "stages/refine/surface_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "stages/refine/section_path.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;
using support::toothed_sheet;

/// Where a vertex of the result lies on the surface.
SurfacePoint foot(const Case& c, Index v) {
  return {c.quads.provenance.face[v], c.quads.provenance.barycentric[v]};
}

/// A sheet between the legs of another one lies nearer to what is between them, but is another
/// part.
TEST(SurfacePoints, StayOnTheirComponent) {
  PolyMesh legs;
  legs.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(3, 0, 0),   Vec3(4, 0, 0),   Vec3(0, 1, 0),
                    Vec3(1, 1, 0), Vec3(3, 1, 0), Vec3(4, 1, 0),   Vec3(0, 4, 0),   Vec3(1, 4, 0),
                    Vec3(3, 4, 0), Vec3(4, 4, 0), Vec3(1.2, 2, 0), Vec3(2.8, 2, 0), Vec3(2, 4, 0)};
  for (const auto& face : std::vector<std::array<Index, 3>>{{0, 1, 5},
                                                            {0, 5, 4},
                                                            {1, 2, 6},
                                                            {1, 6, 5},
                                                            {2, 3, 7},
                                                            {2, 7, 6},
                                                            {4, 5, 9},
                                                            {4, 9, 8},
                                                            {6, 7, 11},
                                                            {6, 11, 10},
                                                            {12, 13, 14}}) {
    legs.add_face(face);
  }
  const TriMesh mesh = support::plain_tri_mesh(legs);
  const SurfacePoints points(mesh);
  const auto inside = [](Index face) { return SurfacePoint{face, {0.2, 0.4, 0.4}}; };
  const SurfacePoint a = inside(6);
  const SurfacePoint b = inside(9);
  const Vec3 middle = (place_of(mesh, a) + place_of(mesh, b)) / 2;
  for (const Vec3& normal : {Vec3(0, 0, 1), Vec3(0, 0, -1)}) {
    EXPECT_LT(points.between(a, b, middle, normal).face, 10);
  }
}

/// New vertices on a sharp rim lie on the rim, in the middle of its arc, not of the chord.
TEST(SurfacePoints, MiddlesOfRimsAreOnTheRim) {
  SampleOptions sample;
  sample.faces = 8000;
  sample.jitter = 0.0;
  SilentObserver observer;
  const TriMesh mesh =
      import_mesh(make_sample(SampleKind::cylinder, sample), ImportOptions{}, observer).mesh;
  const SurfacePoints points(mesh);
  Index start = 0;
  while (mesh.is_feature[start] == 0) ++start;
  const auto at_vertex = [](Index h) {
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 1;
    return point;
  };
  // Some edges on along the rim, with a circle's chord between.
  Index h = start;
  for (int i = 0; i < 10; ++i) {
    Index next = TriMesh::next(h);
    while (mesh.is_feature[next] == 0) next = mesh.rotate_cw(next);
    h = next;
  }
  const SurfacePoint a = at_vertex(start);
  const SurfacePoint b = at_vertex(h);
  const Vec3 chord = (place_of(mesh, a) + place_of(mesh, b)) / 2;
  const SurfacePoint middle = points.between(a, b, chord, Vec3::UnitZ());
  const Vec3 place = place_of(mesh, middle);
  EXPECT_TRUE(points.is_on_line(middle));
  EXPECT_NEAR(std::abs(place.z()), kCylinderHalfHeight, 1e-9);
  // On the rim's polygon, between radius and its apothem; on the bisector of a and b.
  EXPECT_GT(std::hypot(place.x(), place.y()), 0.995 * kCylinderRadius);
  EXPECT_NEAR((place - place_of(mesh, a)).norm(), (place - place_of(mesh, b)).norm(), 0.01);
}

/// Across a deep valley the middle of the way lies at its bottom, where the point nearest to the
/// chord lies on a bank.
TEST(SurfacePoints, MiddlesStayOnTheWayOverTheSurface) {
  const Case c =
      grid(64, 2, [](double x, double) { return -2 * std::exp(-50 * (x - 0.5) * (x - 0.5)); });
  const SurfacePoints points(c.mesh);
  // Vertices 3 and 5 are at y = 0.5, on the two banks; the way between is about 4.1 long.
  const auto middle = split_of_section(c.mesh, foot(c, 3), foot(c, 5), Vec3::UnitZ(), 10);
  ASSERT_TRUE(middle.has_value());
  EXPECT_NEAR(place_of(c.mesh, *middle).z(), -2, 0.01);
  EXPECT_NEAR(place_of(c.mesh, *middle).x(), 0.5, 0.01);
  EXPECT_FALSE(split_of_section(c.mesh, foot(c, 3), foot(c, 5), Vec3::UnitZ(), 4).has_value());
  // On one bank, between vertices 5 and 8, it is the middle of the edge.
  const Vec3 chord = (c.quads.mesh.positions[5] + c.quads.mesh.positions[8]) / 2;
  EXPECT_NEAR(
      (place_of(c.mesh, points.between(foot(c, 5), foot(c, 8), chord, Vec3::UnitZ())) - chord)
          .norm(),
      0, 1e-9);
}

/// An edge of a result over a jagged boundary has its new vertices on that, whether it ends at
/// corners or passes them.
TEST(SurfacePoints, LeadAlongJaggedBoundaries) {
  Case c = toothed_sheet(8, 1, 0.1);
  std::ranges::fill(c.mesh.is_corner, 1);  // the whole boundary turns
  const SurfacePoints points(c.mesh);
  // Around the surface on the left: from the right end of the toothed side to its left one.
  const SurfacePoint right = foot(c, 3);
  const SurfacePoint left = foot(c, 2);
  EXPECT_NEAR(points.boundary_height(right, left), 0.1, 1e-12);
  const auto middle = points.between_on_boundary(right, left);
  ASSERT_TRUE(middle.has_value());
  // Tooth 3 or 4: the middle of the way is between them, and clearly less far from the chord.
  EXPECT_NEAR(place_of(c.mesh, *middle).y() + c.mesh.origin.y(), 1.1, 1e-12);
  // Not the long way around, against the sense of the boundary.
  EXPECT_FALSE(points.between_on_boundary(left, right).has_value());
  EXPECT_EQ(points.boundary_height(left, right), 0);
}

/// The middle of an edge across a notch is not where the boundary has its vertex.
TEST(SurfacePoints, MiddlesOfInnerEdgesLeaveTheBoundaryItsVertices) {
  const Case c = toothed_sheet(8, 1, 0.02);
  const SurfacePoints points(c.mesh);
  const auto tip = [&](Index tooth) { return SurfacePoint{2 * 8 * 8 + tooth, {0, 1, 0}}; };
  const Vec3 a = place_of(c.mesh, tip(3));
  const Vec3 b = place_of(c.mesh, tip(4));
  const Vec3 place = place_of(c.mesh, points.between(tip(3), tip(4), (a + b) / 2, Vec3::UnitZ()));
  for (const Vec3& p : c.mesh.positions) EXPECT_GT((p - place).norm(), 1e-3);
}

/// Where an edge spans a hole, and the faces beside it are turned over, its middle stays on the
/// sheet of its ends.
TEST(SurfacePoints, MiddlesStayOnTheirSheetWhereFacesAreTurnedOver) {
  PolyMesh soup;
  for (const double z : {0.0, -3.0}) {
    const Index first = soup.vertex_count();
    for (Index i = 0; i < 16; ++i) soup.positions.emplace_back(i % 4, i / 4, z);
    for (Index y = 0; y < 3; ++y) {
      for (Index x = 0; x < 3; ++x) {
        if (x == 1 && y == 1) continue;  // the hole
        const Index a = first + 4 * y + x;
        std::array<Index, 3> lower = {a, a + 1, a + 5};
        std::array<Index, 3> upper = {a, a + 5, a + 4};
        if (z < 0) {
          std::swap(lower[0], lower[1]);
          std::swap(upper[0], upper[1]);
        }
        soup.add_face(lower);
        soup.add_face(upper);
      }
    }
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  std::ranges::fill(mesh.is_corner, 1);  // so that no line goes around the hole
  const SurfacePoints points(mesh);
  const auto at_vertex = [&](Index v) {
    const Index h = mesh.vertex_out[v];
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 1;
    return point;
  };
  // Opposite corners of the hole.
  const Vec3 middle = (mesh.positions[5] + mesh.positions[10]) / 2;
  const SurfacePoint found =
      points.between(at_vertex(5), at_vertex(10), middle, Vec3(-Vec3::UnitZ()));
  EXPECT_NEAR(place_of(mesh, found).z(), mesh.positions[5].z(), 1e-12);
}

}  // namespace
}  // namespace strake
