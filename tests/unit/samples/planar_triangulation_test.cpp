#include "common/geometry/samples/planar_triangulation.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "common/geometry/samples/random.h"

namespace strake {
namespace {

constexpr Index kFirst = PlanarTriangulation::kFirstVertex;

double signed_area(const Vec2& a, const Vec2& b, const Vec2& c) {
  return ((b - a).x() * (c - a).y() - (b - a).y() * (c - a).x()) / 2;
}

/// Positive where p lies inside the circle through a, b, c (counter-clockwise); a length^4.
double in_circle(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& p) {
  Mat3 m;
  int row = 0;
  for (const Vec2& q : {a, b, c}) {
    const Vec2 d = q - p;
    m.row(row++) << d.x(), d.y(), d.squaredNorm();
  }
  return m.determinant();
}

bool touches_frame(const PlanarTriangulation::Triangle& t) {
  return *std::min_element(t.vertices.begin(), t.vertices.end()) < kFirst;
}

/// Neighbours name each other across the same edge.
void expect_consistent(const PlanarTriangulation& plane) {
  const auto& triangles = plane.triangles();
  for (Index t = 0; t < static_cast<Index>(triangles.size()); ++t) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Index other = triangles[t].neighbours[i];
      if (other == kNone) continue;
      const auto& back = triangles[other];
      const auto k = static_cast<std::size_t>(
          std::find(back.neighbours.begin(), back.neighbours.end(), t) - back.neighbours.begin());
      ASSERT_LT(k, 3U);
      EXPECT_EQ(back.vertices[(k + 1) % 3], triangles[t].vertices[(i + 2) % 3]);
      EXPECT_EQ(back.vertices[(k + 2) % 3], triangles[t].vertices[(i + 1) % 3]);
      EXPECT_EQ(back.locked[k], triangles[t].locked[i]);
    }
  }
}

TEST(PlanarTriangulation, EveryCircumcircleIsEmpty) {
  UniformRandom random(7);
  PlanarTriangulation plane(Vec2(-1, -1), Vec2(1, 1));
  std::vector<Vec2> points;
  for (int i = 0; i < 300; ++i) {
    points.emplace_back(random.symmetric(), random.symmetric());
    ASSERT_EQ(plane.insert(points.back()), kFirst + i);
  }
  expect_consistent(plane);
  // A planar triangulation of n points within a frame of 4 has 2 (n + 4) - 2 - 4 triangles.
  EXPECT_EQ(plane.triangles().size(), 2 * points.size() + 2);
  for (const auto& t : plane.triangles()) {
    if (touches_frame(t)) continue;
    const Vec2 &a = points[t.vertices[0] - kFirst], &b = points[t.vertices[1] - kFirst],
               &c = points[t.vertices[2] - kFirst];
    EXPECT_GT(signed_area(a, b, c), 0);
    for (const Vec2& p : points) {
      // Rounding to the grid moves points by 2^-25, the determinant by 16 times that at most.
      EXPECT_LT(in_circle(a, b, c, p), 16 * 0x1p-25);
    }
  }
}

TEST(PlanarTriangulation, RegularGridWithAllItsTiesStaysConsistent) {
  PlanarTriangulation plane(Vec2(0, 0), Vec2(1, 1));
  constexpr int kSide = 17;
  for (int i = 0; i < kSide * kSide; ++i) {
    ASSERT_NE(plane.insert(Vec2(i % kSide, i / kSide) / (kSide - 1)), kNone);
  }
  expect_consistent(plane);
  double area = 0;
  for (const auto& t : plane.triangles()) {
    if (touches_frame(t)) continue;
    std::array<Vec2, 3> p;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index v = t.vertices[i] - kFirst;
      p[i] = Vec2(v % kSide, v / kSide) / (kSide - 1);
    }
    EXPECT_GT(signed_area(p[0], p[1], p[2]), 0);
    area += signed_area(p[0], p[1], p[2]);
  }
  EXPECT_NEAR(area, 1, 1e-12);
}

TEST(PlanarTriangulation, RefusesAPointThatIsThereAlready) {
  PlanarTriangulation plane(Vec2(0, 0), Vec2(1, 1));
  ASSERT_NE(plane.insert(Vec2(0.25, 0.5)), kNone);
  EXPECT_EQ(plane.insert(Vec2(0.25, 0.5)), kNone);
}

class LockedSquare : public ::testing::Test {
 protected:
  LockedSquare() : plane_(Vec2(0, 0), Vec2(4, 4)) {
    for (const Vec2& p : {Vec2(0, 0), Vec2(4, 0), Vec2(4, 4), Vec2(0, 4), Vec2(1, 1), Vec2(3, 1),
                          Vec2(3, 3), Vec2(1, 3)}) {
      plane_.insert(p);
    }
    for (Index ring = 0; ring < 2; ++ring) {
      for (Index i = 0; i < 4; ++i) {
        EXPECT_TRUE(plane_.lock_edge(kFirst + 4 * ring + i, kFirst + 4 * ring + (i + 1) % 4));
      }
    }
    plane_.mark_inside();
  }

  PlanarTriangulation plane_;
};

TEST_F(LockedSquare, InsideIsBetweenTheRings) {
  const std::array<Vec2, 8> p = {Vec2(0, 0), Vec2(4, 0), Vec2(4, 4), Vec2(0, 4),
                                 Vec2(1, 1), Vec2(3, 1), Vec2(3, 3), Vec2(1, 3)};
  double area = 0;
  for (const auto& t : plane_.triangles()) {
    if (!t.inside) continue;
    ASSERT_FALSE(touches_frame(t));
    area += signed_area(p[t.vertices[0] - kFirst], p[t.vertices[1] - kFirst],
                        p[t.vertices[2] - kFirst]);
  }
  EXPECT_NEAR(area, 16 - 4, 1e-12);
}

TEST_F(LockedSquare, LockedEdgesSurvivePointsBesideThem) {
  Index start = 0;
  while (!plane_.triangles()[start].inside) ++start;
  for (const double x : {0.1, 0.7, 1.3, 2.1, 2.6, 3.4}) {
    if (!plane_.open_cavity(Vec2(x, 0.05), start, true)) continue;
    plane_.fill_cavity();
    start = plane_.fresh().front();
  }
  expect_consistent(plane_);
  EXPECT_TRUE(plane_.lock_edge(kFirst, kFirst + 1));
}

TEST_F(LockedSquare, NothingGetsOntoOrAcrossALockedEdge) {
  Index start = 0;
  while (!plane_.triangles()[start].inside) ++start;
  EXPECT_FALSE(plane_.open_cavity(Vec2(2, 1), start, true)) << "on the edge of the inner ring";
  EXPECT_FALSE(plane_.open_cavity(Vec2(2, 2), start, true)) << "in the hole";
}

TEST_F(LockedSquare, AnEdgeThatIsNotThereCannotBeLocked) {
  EXPECT_FALSE(plane_.lock_edge(kFirst, kFirst + 2));
}

}  // namespace
}  // namespace strake
