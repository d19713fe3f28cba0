#include "common/geometry/face_crossings/face_crossings.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "common/geometry/face_crossings/exact_predicates.h"
#include "common/geometry/samples/samples.h"

namespace strake {
namespace {

using Triangle = std::array<Vec3, 3>;

// Kettner et al. 2008: near the diagonal, steps of one unit in the last place; p is left of the
// line through (12, 12) and (24, 24) where its y is larger. Plain doubles get hundreds of these
// wrong.
TEST(Orientation, OfAPointBesideALineIsExact) {
  const double ulp = std::ldexp(1.0, -53);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec2 p(0.5 + i * ulp, 0.5 + j * ulp);
      EXPECT_EQ(orientation(Vec2(12, 12), Vec2(24, 24), p), (j > i) - (j < i)) << i << " " << j;
    }
  }
}

// The same in space: the plane x = y.
TEST(Orientation, OfAPointBesideAPlaneIsExact) {
  const double ulp = std::ldexp(1.0, -53);
  const Vec3 a(12, 12, 0);
  const Vec3 b(24, 24, 0);
  const Vec3 c(7, 7, 31);
  ASSERT_EQ(orientation(a, b, c, Vec3(0, 1, 0)), 1);
  for (int i = 0; i < 64; ++i) {
    for (int j = 0; j < 64; ++j) {
      const Vec3 p(0.5 + i * ulp, 0.5 + j * ulp, 0.3);
      EXPECT_EQ(orientation(a, b, c, p), (j > i) - (j < i)) << i << " " << j;
    }
  }
}

/// Triangles with a known relation, at random.
class RandomTriangles {
 public:
  Vec3 point() { return Vec3(uniform(), uniform(), uniform()); }
  Triangle triangle() { return {point(), point(), point()}; }
  /// A triangle that has `p` inside, not on its border.
  Triangle around(const Vec3& p) {
    Triangle t = triangle();
    const Vec3 weights = Vec3(1 + uniform(), 1 + uniform(), 1 + uniform()) + Vec3::Constant(0.1);
    const Vec3 inside = (weights[0] * t[0] + weights[1] * t[1] + weights[2] * t[2]) / weights.sum();
    for (Vec3& corner : t) corner += p - inside;
    return t;
  }

 private:
  double uniform() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  std::mt19937_64 random_{7};
};

TEST(TrianglesCross, WhereTheyHaveAPointInCommon) {
  RandomTriangles random;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.point();
    const Triangle a = random.around(p);
    const Triangle b = random.around(p);
    EXPECT_TRUE(triangles_cross(a, b)) << i;
    EXPECT_TRUE(triangles_cross(b, a)) << i;
  }
}

TEST(TrianglesCross, NotWhereAPlaneSeparatesThem) {
  RandomTriangles random;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 normal = random.point().normalized();
    Triangle a = random.triangle();
    Triangle b = random.triangle();
    for (Vec3& p : a) p += (1e-3 + std::abs(p.dot(normal)) - p.dot(normal)) * normal;
    for (Vec3& p : b) p -= (1e-3 + std::abs(p.dot(normal)) + p.dot(normal)) * normal;
    EXPECT_FALSE(triangles_cross(a, b)) << i;
  }
}

TEST(TrianglesCross, NotInTheirSharedCornersAndEdges) {
  const Triangle a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_FALSE(triangles_cross(a, {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, -1, 0)}));  // flat
  EXPECT_FALSE(triangles_cross(a, {Vec3(1, 0, 0), Vec3(0, 0, 0), Vec3(0, 1, 1e-9)}));
  EXPECT_FALSE(triangles_cross(a, {Vec3(0, 0, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}));
  EXPECT_FALSE(triangles_cross(a, {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(1, 1, 2)}));
}

TEST(TrianglesCross, WhereTheyTouchOrLieOnEachOther) {
  const Triangle a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  EXPECT_TRUE(triangles_cross(a, {Vec3(0.25, 0.25, 0), Vec3(0, 0, 1), Vec3(1, 0, 1)}));  // a corner
  EXPECT_TRUE(triangles_cross(a, {Vec3(0.5, 0, 0), Vec3(0.5, -1, 1), Vec3(0.5, -1, -1)}));
  EXPECT_TRUE(triangles_cross(a, {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0.25, 0)}));  // folded
  EXPECT_TRUE(triangles_cross(a, {Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0.5, 0)}));  // in the plane
  EXPECT_TRUE(triangles_cross(a, {Vec3(-1, -1, 0), Vec3(3, -1, 0), Vec3(-1, 3, 0)}));  // around it
  EXPECT_TRUE(triangles_cross(a, {Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(1, 1, -1)}));
  EXPECT_TRUE(triangles_cross(a, a));
}

// In a plane, triangles are apart exactly where an edge of one has the other strictly beyond it;
// whole numbers tell that without rounding. Lattices so small make corners meet corners and edges.
TEST(TrianglesCross, InAPlaneAsWholeNumbersSay) {
  using Point = std::array<int, 2>;
  using FlatTriangle = std::array<Point, 3>;
  std::mt19937_64 random(5);
  const auto turn = [](const Point& a, const Point& b, const Point& c) {
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  };
  const auto triangle = [&] {
    std::uniform_int_distribution<int> place(-4, 4);
    FlatTriangle t{};
    do {
      for (Point& p : t) p = {place(random), place(random)};
    } while (turn(t[0], t[1], t[2]) <= 0);
    return t;
  };
  const auto has_beyond = [&](const FlatTriangle& a, const FlatTriangle& b) {
    for (int i = 0; i < 3; ++i) {
      if (std::ranges::all_of(b, [&](const Point& p) { return turn(a[i], a[(i + 1) % 3], p) < 0; }))
        return true;
    }
    return false;
  };
  const auto in_space = [](const FlatTriangle& t, double unit) {
    Triangle placed;
    for (int i = 0; i < 3; ++i) {
      placed[i] = unit * Vec3(t[i][0] + 1000, t[i][1], t[i][0] + 2 * t[i][1]);
    }
    return placed;
  };
  int crossing = 0;
  for (int i = 0; i < 20000; ++i) {
    const FlatTriangle a = triangle();
    const FlatTriangle b = triangle();
    const bool shares_a_corner =
        std::ranges::any_of(a, [&](const Point& p) { return std::ranges::find(b, p) != b.end(); });
    if (shares_a_corner) continue;
    const bool expected = !has_beyond(a, b) && !has_beyond(b, a);
    crossing += expected ? 1 : 0;
    for (const double unit : {1.0, 0x1p-90, 0x1p150}) {
      EXPECT_EQ(triangles_cross(in_space(a, unit), in_space(b, unit)), expected)
          << i << ' ' << unit;
    }
  }
  EXPECT_GT(crossing, 5000);
}

// Faces of a result may shrink to a line or a point; what has no area meets nothing.
TEST(TrianglesCross, NotWithoutAnArea) {
  const Triangle a = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const Triangle line = {Vec3(0.2, 0.2, 0), Vec3(0.4, 0.2, 0), Vec3(0.3, 0.2, 0)};
  const Triangle through = {Vec3(0.2, 0.2, -1), Vec3(0.2, 0.2, 1), Vec3(0.2, 0.2, 0.5)};
  const Triangle edge = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0)};
  const Triangle point = {Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0)};
  for (const Triangle& b : {line, through, edge, point}) {
    EXPECT_FALSE(triangles_cross(a, b));
    EXPECT_FALSE(triangles_cross(b, a));
    EXPECT_FALSE(triangles_cross(b, b));
  }
}

PolyMesh torus() {
  SampleOptions options;
  options.faces = 3000;
  return make_sample(SampleKind::torus, options);
}

TEST(CrossingFaces, AreNoneOnATorus) {
  const PolyMesh mesh = torus();
  EXPECT_TRUE(find_crossing_faces(mesh.positions, triangulate_faces(mesh)).empty());
}

TEST(CrossingFaces, AreThoseThatAllPairsGive) {
  PolyMesh mesh = torus();
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, 0.03);
  for (Vec3& p : mesh.positions) p += Vec3(noise(random), noise(random), noise(random));
  const FaceTriangles triangles = triangulate_faces(mesh);
  std::vector<std::array<Index, 2>> expected;
  const auto shape = [&](std::size_t t) -> Triangle {
    const auto& [a, b, c] = triangles.corners[t];
    return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
  };
  for (std::size_t s = 0; s < triangles.face.size(); ++s) {
    for (std::size_t t = s + 1; t < triangles.face.size(); ++t) {
      if (triangles_cross(shape(s), shape(t))) {
        expected.push_back({triangles.face[s], triangles.face[t]});
      }
    }
  }
  ASSERT_GT(expected.size(), 10u);
  for (const std::size_t threads : {1, 3}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(find_crossing_faces(mesh.positions, triangles), expected);
  }
  std::vector<std::uint8_t> wanted(static_cast<std::size_t>(mesh.face_count()), 0);
  for (std::size_t f = 0; f < wanted.size(); f += 3) wanted[f] = 1;
  std::erase_if(expected, [&](const auto& pair) { return !wanted[pair[0]] && !wanted[pair[1]]; });
  EXPECT_EQ(find_crossing_faces(mesh.positions, triangles, wanted, {}), expected);
  std::vector<std::array<Index, 2>> known;
  std::vector<std::array<Index, 2>> others;
  for (const auto& pair : expected) (pair[1] % 2 == 0 ? known : others).push_back(pair);
  EXPECT_EQ(find_crossing_faces(mesh.positions, triangles, wanted, known), others);
}

TEST(CrossingFaces, AreOfDifferentFacesAndHaveAnArea) {
  PolyMesh mesh;
  // A quad that crosses itself, and a triangle through it without area, then with one.
  mesh.positions = {{0, 0, 0},      {1, 0, 0},     {0, 1, 0}, {1, 1, 0},
                    {0.5, 0.2, -1}, {0.5, 0.2, 1}, {5, 5, 1}};
  mesh.add_face(std::vector<Index>{0, 1, 2, 3});
  mesh.add_face(std::vector<Index>{4, 5, 4});
  EXPECT_TRUE(find_crossing_faces(mesh.positions, triangulate_faces(mesh)).empty());
  mesh.corners.back() = 6;
  EXPECT_EQ(find_crossing_faces(mesh.positions, triangulate_faces(mesh)).size(), 1u);
}

}  // namespace
}  // namespace strake
