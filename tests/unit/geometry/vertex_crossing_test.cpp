#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/geometry/face_chart.h"
#include "common/geometry/mesh_measures.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A fan of triangles around vertex 0 whose corners there have the given angles. Closed where the
/// last side is to meet the first: then the angles may sum to anything below a full turn, and the
/// sides are placed on a cone; or to exactly a full turn.
TriMesh open_fan(const std::vector<double>& angles) {
  PolyMesh soup;
  soup.positions.push_back(Vec3::Zero());
  double angle = 0.3;
  for (std::size_t i = 0; i <= angles.size(); ++i) {
    const double r = 1 + 0.2 * std::sin(3.0 * static_cast<double>(i));
    soup.positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
    if (i < angles.size()) angle += angles[i];
  }
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto k = static_cast<Index>(i);
    soup.add_face(std::array<Index, 3>{0, k + 1, k + 2});
  }
  return support::plain_tri_mesh(soup);
}

/// A closed fan around vertex 0: n spokes of different lengths on a cone of this height (0: flat).
TriMesh closed_fan(int n, double height) {
  PolyMesh soup;
  soup.positions.push_back(Vec3::Zero());
  for (int i = 0; i < n; ++i) {
    const double turn = 2 * M_PI * (i + 0.2 * std::sin(5.0 * i)) / n;
    const double r = 1 + 0.3 * std::cos(2.0 * i);
    soup.positions.push_back(r * Vec3(std::cos(turn), std::sin(turn), -height));
  }
  for (Index i = 0; i < n; ++i) soup.add_face(std::array<Index, 3>{0, i + 1, (i + 1) % n + 1});
  return support::plain_tri_mesh(soup);
}

/// The corners around vertex 0, counter-clockwise, from the clockwise-most or any.
std::vector<Index> corners_around(const TriMesh& mesh) {
  std::vector<Index> corners;
  for (Index h = mesh.vertex_out[0]; h != kNone; h = mesh.rotate_ccw(h)) {
    if (!corners.empty() && h == corners.front()) break;
    corners.push_back(h);
  }
  return corners;
}

/// Angle of a place in the fan, counter-clockwise from its first corner.
double fan_angle(const TriMesh& mesh, const std::vector<Index>& corners, Index corner,
                 double angle) {
  for (const Index h : corners) {
    if (h == corner) return angle;
    angle += corner_angle(mesh, h);
  }
  ADD_FAILURE() << "no corner of the fan";
  return 0;
}

void expect_half_way_round(const TriMesh& mesh) {
  const std::vector<Index> corners = corners_around(mesh);
  double total = 0;
  for (const Index h : corners) total += corner_angle(mesh, h);
  for (const Index h : corners) {
    for (const double share : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const double back = share * corner_angle(mesh, h);
      const auto exit = cross_vertex(mesh, h, back);
      ASSERT_TRUE(exit.has_value());
      EXPECT_GE(exit->angle, 0);
      EXPECT_LE(exit->angle, corner_angle(mesh, exit->corner) + 1e-12);
      const double from = fan_angle(mesh, corners, h, back);
      const double to = fan_angle(mesh, corners, exit->corner, exit->angle);
      const double turn = std::fmod(to - from + 2 * total, total);
      EXPECT_NEAR(turn, total / 2, 1e-12);
    }
  }
}

TEST(CrossVertex, GoesStraightOnWhereTheSurfaceIsFlat) {
  for (const int n : {3, 4, 5, 8, 17}) {
    const TriMesh mesh = closed_fan(n, 0);
    for (const Index h : corners_around(mesh)) {
      const double back = 0.37 * corner_angle(mesh, h);
      const auto exit = cross_vertex(mesh, h, back);
      ASSERT_TRUE(exit.has_value());
      const auto direction = [&](Index corner, double angle) {
        const Vec3& tip = mesh.positions[mesh.to(corner)];
        const double turn = std::atan2(tip.y(), tip.x()) + angle;
        return Vec2(std::cos(turn), std::sin(turn));
      };
      EXPECT_NEAR((direction(h, back) + direction(exit->corner, exit->angle)).norm(), 0, 1e-12);
    }
  }
}

TEST(CrossVertex, HasHalfTheAngleOnEachSideOfACone) {
  for (const double height : {0.0, 0.3, 1.0, 5.0}) {
    for (const int n : {3, 4, 7, 12}) expect_half_way_round(closed_fan(n, height));
  }
}

TEST(CrossVertex, HasHalfTheAngleOnEachSideOfASaddle) {
  // Spokes alternately up and down: the angles sum to more than a full turn.
  PolyMesh soup;
  soup.positions.push_back(Vec3::Zero());
  constexpr Index kSpokes = 8;
  for (Index i = 0; i < kSpokes; ++i) {
    const double turn = 2 * M_PI * i / kSpokes;
    soup.positions.emplace_back(std::cos(turn), std::sin(turn), i % 2 == 0 ? 0.8 : -0.8);
  }
  for (Index i = 0; i < kSpokes; ++i) {
    soup.add_face(std::array<Index, 3>{0, i + 1, (i + 1) % kSpokes + 1});
  }
  expect_half_way_round(support::plain_tri_mesh(soup));
}

TEST(CrossVertex, AtTheBoundaryGoesStraightOnOrLeavesTheSurface) {
  for (const std::vector<double>& angles :
       {std::vector<double>{0.7, 1.1, 0.4}, {0.9, 1.2, 1.04159265}, {1.2, 1.4, 1.5, 0.6}}) {
    const TriMesh mesh = open_fan(angles);
    const std::vector<Index> corners = corners_around(mesh);
    ASSERT_EQ(corners.size(), angles.size());
    double total = 0;
    for (const double a : angles) total += a;
    for (const Index h : corners) {
      for (const double share : {0.07, 0.33, 0.61, 0.93}) {
        const double back = share * corner_angle(mesh, h);
        const double from = fan_angle(mesh, corners, h, back);
        // In the plane of the fan the way on is a half turn away, on either side.
        std::optional<double> expected;
        if (from + M_PI < total) expected = from + M_PI;
        if (from - M_PI > 0) expected = from - M_PI;
        const auto exit = cross_vertex(mesh, h, back);
        ASSERT_EQ(exit.has_value(), expected.has_value()) << "from " << from << " of " << total;
        if (!exit) continue;
        EXPECT_NEAR(fan_angle(mesh, corners, exit->corner, exit->angle), *expected, 1e-12);
      }
    }
  }
}

}  // namespace
}  // namespace strake
