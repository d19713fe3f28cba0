#include "common/geometry/surface_distance/surface_distance.h"

#include <gtest/gtest.h>
#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/core/error.h"

namespace strake {
namespace {

class Random {
 public:
  Vec3 point(double size) { return size * Vec3(symmetric(), symmetric(), symmetric()); }

 private:
  double symmetric() { return static_cast<double>(engine_()) / 2147483648.0 - 1; }
  std::mt19937 engine_{11};
};

struct Scattered {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> corners;
};

/// Triangles of size `size` scattered over [-1, 1]^3, some of them segments and points.
Scattered scattered(Index count, double size, const Vec3& offset) {
  Random random;
  Scattered result;
  for (Index t = 0; t < count; ++t) {
    const Vec3 middle = random.point(1) + offset;
    for (int k = 0; k < 3; ++k) result.positions.push_back(middle + random.point(size));
    std::array<Index, 3> corners = {3 * t, 3 * t + 1, 3 * t + 2};
    if (t % 10 == 3) corners[2] = corners[1];
    if (t % 10 == 7) corners[2] = corners[1] = corners[0];
    result.corners.push_back(corners);
  }
  return result;
}

// q is nearest to p in a convex set if and only if (p - q) . (x - q) <= 0 for all x of the set; for
// a triangle its corners suffice.
TEST(ClosestPointOnTriangle, SatisfiesTheOptimalityCondition) {
  Random random;
  for (int i = 0; i < 2000; ++i) {
    std::array<Vec3, 3> t = {random.point(1), random.point(1), random.point(1)};
    if (i % 5 == 1) t[2] = t[0] + 0.3 * (t[1] - t[0]);  // on a line
    if (i % 5 == 2) t[1] = t[0];
    const Vec3 p = random.point(2);
    const ClosestPoint found = closest_point_on_triangle(p, t[0], t[1], t[2]);
    Vec3 q = Vec3::Zero();
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(found.barycentric[k], 0);
      sum += found.barycentric[k];
      q += found.barycentric[k] * t[k];
    }
    EXPECT_NEAR(sum, 1, 1e-12);
    EXPECT_NEAR((p - q).norm(), found.distance, 1e-9);
    for (const Vec3& corner : t) EXPECT_LE((p - q).dot(corner - q), 1e-8);
  }
}

TEST(SurfaceDistance, AgreesWithAllTrianglesOneByOne) {
  for (const double offset : {0.0, 1e6}) {
    const Vec3 shift = Vec3::Constant(offset);
    const Scattered set = scattered(400, 0.2, shift);
    const SurfaceDistance surface(set.positions, set.corners);
    Random random;
    for (int i = 0; i < 300; ++i) {
      const Vec3 p = random.point(i % 3 == 0 ? 100 : 1.5) + shift;
      ClosestPoint best;
      for (std::size_t t = 0; t < set.corners.size(); ++t) {
        const auto& [a, b, c] = set.corners[t];
        ClosestPoint at =
            closest_point_on_triangle(p, set.positions[a], set.positions[b], set.positions[c]);
        at.triangle = static_cast<Index>(t);
        if (at.distance < best.distance) best = at;
      }
      const ClosestPoint found = surface.closest(p);
      EXPECT_EQ(found.distance, best.distance);
      EXPECT_EQ(found.triangle, best.triangle);
      EXPECT_EQ(found.barycentric, best.barycentric);
      const ClosestPoint guessed = surface.closest_near(p, (7 * i) % 400);
      EXPECT_EQ(guessed.distance, best.distance);
      EXPECT_EQ(guessed.triangle, best.triangle);
    }
  }
}

TEST(SurfaceDistance, EquallyNearTrianglesGiveTheLeastIndex) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  const std::vector<std::array<Index, 3>> copies(50, {0, 1, 2});
  const SurfaceDistance surface(positions, copies);
  EXPECT_EQ(surface.closest({0.2, 0.2, 1}).triangle, 0);
}

TEST(SurfaceDistance, QueriesMayRunInParallel) {
  const Scattered set = scattered(500, 0.1, Vec3::Zero());
  const SurfaceDistance surface(set.positions, set.corners);
  Random random;
  std::vector<Vec3> points;
  for (int i = 0; i < 2000; ++i) points.push_back(random.point(1.2));
  std::vector<ClosestPoint> found(points.size());
  tbb::parallel_for(std::size_t{0}, points.size(),
                    [&](std::size_t i) { found[i] = surface.closest(points[i]); });
  for (std::size_t i = 0; i < points.size(); ++i) {
    const ClosestPoint alone = surface.closest(points[i]);
    EXPECT_EQ(found[i].triangle, alone.triangle);
    EXPECT_EQ(found[i].distance, alone.distance);
    EXPECT_NEAR((surface.point(alone) - points[i]).norm(), alone.distance, 1e-12);
  }
}

TEST(SurfaceDistance, FilterAndReachAreRespected) {
  const std::vector<Vec3> positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0},
                                       {0, 0, 5}, {1, 0, 5}, {0, 1, 5}};
  const SurfaceDistance::Triangles triangles = {{0, 1, 2}, {3, 4, 5}};
  const SurfaceDistance surface(positions, triangles);
  const Vec3 p(0.2, 0.2, 1);
  const auto only_second = [](Index t) { return t == 1; };
  EXPECT_EQ(surface.closest_if(p, 10, only_second).triangle, 1);
  EXPECT_DOUBLE_EQ(surface.closest_if(p, 10, only_second).distance, 4);
  EXPECT_EQ(surface.closest_if(p, 4, only_second).triangle, 1);
  EXPECT_EQ(surface.closest_if(p, 3.99, only_second).triangle, kNone);
  EXPECT_EQ(surface.closest_if(p, 10, [](Index) { return false; }).triangle, kNone);
}

// The distance to a triangle and the one to its box are rounded each in its way: points lie a hair
// from corners and edges of triangles, from well shaped ones to segments.
TEST(SurfaceDistance, ATriangleIsFoundWithinItsOwnDistance) {
  Random random;
  for (int i = 0; i < 260; ++i) {
    const Vec3 a = random.point(1).cwiseProduct(Vec3(1e-6, 1, 1));
    const Vec3 b = a + (i % 2 == 0 ? Vec3(random.point(1).x() * Vec3::UnitY()) : random.point(1));
    const Vec3 c = b + std::pow(10.0, -(i % 13)) * random.point(1);
    const std::vector<Vec3> positions = {a, b, c};
    const std::vector<std::array<Index, 3>> triangles = {{0, 1, 2}};
    const SurfaceDistance surface(positions, triangles);
    for (int k = 0; k < 200; ++k) {
      Vec3 p = a + k / 200.0 * (b - a);
      p.x() = std::nextafter(p.x(), k % 2 == 0 ? 2.0 : -2.0);
      const double reach = closest_point_on_triangle(p, a, b, c).distance;
      EXPECT_EQ(surface.closest_within(p, reach).triangle, 0) << i << " " << k;
    }
  }
}

TEST(SurfaceDistance, NothingToMeasureAgainstIsRefused) {
  const std::vector<Vec3> positions;
  const SurfaceDistance::Triangles triangles;
  EXPECT_THROW(SurfaceDistance(positions, triangles), PreconditionError);
}

}  // namespace
}  // namespace strake
