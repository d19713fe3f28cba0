#include "common/geometry/poly_topology/face_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>

#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// A planar polygon, turned somewhere into space.
PolyMesh polygon(const std::vector<Vec2>& outline) {
  const Eigen::AngleAxisd turn(0.7, Vec3(1, 2, 3).normalized());
  PolyMesh mesh;
  for (const Vec2& p : outline) mesh.positions.push_back(turn * Vec3(p.x(), p.y(), 0.4));
  std::vector<Index> face(outline.size());
  std::iota(face.begin(), face.end(), 0);
  mesh.add_face(face);
  return mesh;
}

double area_of(const std::vector<Vec2>& outline) {  // shoelace
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec2& a = outline[i];
    const Vec2& b = outline[(i + 1) % outline.size()];
    sum += a.x() * b.y() - a.y() * b.x();
  }
  return sum / 2;
}

std::vector<Vec2> star(int points) {
  std::vector<Vec2> outline;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points;
    const double radius = i % 2 == 0 ? 1.0 : 0.35;
    outline.emplace_back(radius * std::cos(angle), radius * std::sin(angle));
  }
  return outline;
}

const std::vector<Vec2> kDart = {{0, 0}, {2, -1}, {0.5, 0.4}, {1, 3}};
const std::vector<Vec2> kL = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
const std::vector<Vec2> kKite = {{0, 0}, {2, -0.5}, {3, 0}, {2, 0.5}};

TEST(FaceShape, NewellNormalIsTwiceTheArea) {
  for (const auto& outline : {kDart, kL, kKite, star(5)}) {
    const PolyMesh mesh = polygon(outline);
    EXPECT_NEAR(newell_normal(mesh.positions, mesh.face(0)).norm(), 2 * area_of(outline), 1e-12);
  }
}

// A square hole, with the two corners of the bridge to it written twice.
const std::vector<Vec2> kKeyhole = {{0, 0}, {4, 0}, {4, 4}, {0, 4}, {0, 0},
                                    {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}};

// Triangles that all face along the normal and whose areas add up to the polygon's cover it once.
TEST(FaceShape, TrianglesCoverPolygonsOnce) {
  for (const auto& outline : {kDart, kL, kKite, kKeyhole, star(5), star(200)}) {
    const PolyMesh mesh = polygon(outline);
    const Vec3 normal = newell_normal(mesh.positions, mesh.face(0)).normalized();
    std::vector<std::array<Index, 3>> triangles;
    triangulate_face(mesh.positions, mesh.face(0), triangles);
    ASSERT_EQ(triangles.size(), outline.size() - 2);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
      const Vec3 area =
          (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]) / 2;
      EXPECT_GT(area.dot(normal), 0);
      sum += area.dot(normal);
    }
    EXPECT_NEAR(sum, area_of(outline), 1e-11);
  }
}

TEST(FaceShape, ConvexQuadIsSplitAlongTheShorterDiagonal) {
  const PolyMesh mesh = polygon(kKite);
  std::vector<std::array<Index, 3>> triangles;
  triangulate_face(mesh.positions, mesh.face(0), triangles);
  for (const auto& triangle : triangles) {
    EXPECT_EQ(std::count(triangle.begin(), triangle.end(), 1), 1);
    EXPECT_EQ(std::count(triangle.begin(), triangle.end(), 3), 1);
  }
}

TEST(FaceShape, ConcavityIsFoundFromEveryStartAndOnBothSides) {
  const auto check = [](std::vector<Vec2> outline, bool expected) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      std::rotate(outline.begin(), outline.begin() + 1, outline.end());
      const PolyMesh mesh = polygon(outline);
      EXPECT_EQ(is_concave_face(mesh.positions, mesh.face(0)), expected);
      const PolyMesh back = polygon({outline.rbegin(), outline.rend()});
      EXPECT_EQ(is_concave_face(back.positions, back.face(0)), expected);
    }
  };
  check(kDart, true);
  check(kL, true);
  check(kKite, false);
  check({{0, 0}, {1, 0}, {2, 0}, {2, 2}, {0, 2}}, false);  // a straight corner is not concave
}

TEST(FaceShape, EveryTriangleKnowsItsFace) {
  const PolyMesh mesh = support::together(polygon(kL), shapes::square(2, 0));
  const FaceTriangles all = triangulate_faces(mesh);
  ASSERT_EQ(all.face.size(), all.corners.size());
  std::vector<std::size_t> count(static_cast<std::size_t>(mesh.face_count()));
  for (std::size_t t = 0; t < all.face.size(); ++t) {
    ++count[all.face[t]];
    const std::span<const Index> face = mesh.face(all.face[t]);
    for (const Index v : all.corners[t]) {
      EXPECT_NE(std::find(face.begin(), face.end(), v), face.end());
    }
  }
  for (Index f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(count[f] + 2, mesh.face(f).size());
}

/// A closed polygon around the origin, near a plane, not always convex.
PolyMesh rough_polygon(Index sides, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::vector<Vec2> outline;
  for (Index i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    outline.push_back((1 + 0.5 * uniform(random)) * Vec2(std::cos(angle), std::sin(angle)));
  }
  PolyMesh mesh = polygon(outline);
  for (Vec3& p : mesh.positions) p += 0.2 * Vec3(uniform(random), uniform(random), uniform(random));
  return mesh;
}

using Triangles = std::vector<std::array<Index, 3>>;

/// The same for the same triangles in any order, beginning with any corner.
Triangles sorted(Triangles triangles) {
  for (auto& t : triangles) std::rotate(t.begin(), std::ranges::min_element(t), t.end());
  std::ranges::sort(triangles);
  return triangles;
}

// Most programs cut polygons into fans around the first corner.
TEST(FaceShape, FacesBegunAtFansAreMeasuredAsFans) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 300; ++trial) {
    const Index sides = 3 + trial % 3;
    PolyMesh mesh = rough_polygon(sides, random);
    const Triangles measured = sorted(triangulate_faces(mesh).corners);
    begin_faces_at_fans(mesh);
    Triangles fan;
    for (Index i = 1; i + 1 < sides; ++i) {
      fan.push_back({mesh.face(0)[0], mesh.face(0)[i], mesh.face(0)[i + 1]});
    }
    EXPECT_EQ(sorted(fan), measured) << trial;
    EXPECT_EQ(sorted(triangulate_faces(mesh).corners), measured) << trial;
  }
}

TEST(FaceShape, FacesOfManyCornersKeepTheirsWhereThereIsNoFan) {
  const std::vector<Vec2> dart = {kDart[1], kDart[2], kDart[3], kDart[0]};
  PolyMesh mesh = support::together(polygon(star(5)), polygon(dart));
  const PolyMesh before = mesh;
  begin_faces_at_fans(mesh);
  EXPECT_TRUE(std::ranges::equal(mesh.face(0), before.face(0)));
  EXPECT_EQ(mesh.face(1)[0], before.face(1)[1]);  // a dart is cut at its reflex corner
}

TEST(FaceShape, OnlyTiesAreCutOtherwise) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 100; ++trial) {
    EXPECT_TRUE(other_triangulations(rough_polygon(4 + trial % 3, random)).empty());
  }
  const std::vector<FaceTriangles> others = other_triangulations(shapes::square(2, 0));
  ASSERT_EQ(others.size(), 1U);  // its diagonals have the same length
  EXPECT_NE(sorted(others[0].corners), sorted(triangulate_faces(shapes::square(2, 0)).corners));
}

/// Twice the area of the ear at corner 1, as seen along the normal of the face.
double ear_along_normal(const PolyMesh& mesh) {
  const std::vector<Vec3>& p = mesh.positions;
  return (p[1] - p[0]).cross(p[2] - p[0]).dot(newell_normal(p, mesh.face(0)).normalized());
}

// An ear that is upright to the face is one or none as rounding has it.
TEST(FaceShape, UprightEarsAreCutEitherWay) {
  std::mt19937 random(7);
  int upright = 0;
  int told_apart = 0;
  for (int trial = 0; trial < 300; ++trial) {
    PolyMesh mesh = rough_polygon(5, random);
    // Behind the way from corner to corner, but as far up as it takes.
    mesh.positions[1] = 0.45 * (mesh.positions[0] + mesh.positions[2]);
    const auto with_height = [&](double height) {
      PolyMesh other = mesh;
      other.positions[1].z() += height;
      return other;
    };
    double low = 0;
    double high = trial % 2 == 0 ? 3 : -3;
    if (!(ear_along_normal(mesh) * ear_along_normal(with_height(high)) < 0)) continue;
    for (int i = 0; i < 60; ++i) {
      const double middle = (low + high) / 2;
      const bool is_beyond = ear_along_normal(mesh) * ear_along_normal(with_height(middle)) < 0;
      (is_beyond ? high : low) = middle;
    }
    ++upright;
    const PolyMesh tied = with_height(low);
    std::vector<FaceTriangles> all = other_triangulations(tied);
    all.push_back(triangulate_faces(tied));
    const auto just_beside = [&](double side) {
      return sorted(triangulate_faces(with_height(low + side)).corners);
    };
    told_apart += just_beside(-1e-11) != just_beside(1e-11) ? 1 : 0;
    for (const double side : {-1e-11, 1e-11}) {
      EXPECT_TRUE(std::ranges::any_of(all, [&](const FaceTriangles& t) {
        return sorted(t.corners) == just_beside(side);
      })) << trial;
    }
  }
  EXPECT_GT(upright, 20);
  EXPECT_GT(told_apart, 5);
}

}  // namespace
}  // namespace strake
