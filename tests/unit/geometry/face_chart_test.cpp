#include "common/geometry/face_chart.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/geometry/developments.h"

namespace strake {
namespace {

double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

TriMesh rough_torus() {
  SampleOptions options;
  options.faces = 1500;
  options.jitter = 1;
  return support::plain_tri_mesh(make_sample(SampleKind::torus, options));
}

/// All edges as long as in space, and the corners counter-clockwise.
void expect_isometric(const TriMesh& mesh, const FaceChart& chart, double tolerance) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR((chart.corner[(i + 1) % 3] - chart.corner[i]).norm(),
                edge_length(mesh, 3 * chart.face + i), tolerance);
  }
  EXPECT_NEAR(cross2(chart.corner[1] - chart.corner[0], chart.corner[2] - chart.corner[0]) / 2,
              face_area(mesh, chart.face), tolerance);
}

Vec3 random_barycentric(std::mt19937_64& random) {
  std::exponential_distribution<double> exponential;
  const Vec3 b(exponential(random), exponential(random), exponential(random));
  return b / b.sum();
}

Vec2 random_vector(std::mt19937_64& random, double length) {
  const double angle = std::uniform_real_distribution<double>(-M_PI, M_PI)(random);
  return length * Vec2(std::cos(angle), std::sin(angle));
}

constexpr double kTolerance = 1e-13;  // a few roundings on lengths of order one

TEST(FaceChart, LaysFacesOutIsometrically) {
  const TriMesh mesh = rough_torus();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const FaceChart chart = lay_out(mesh, f);
    ASSERT_EQ(chart.face, f);
    expect_isometric(mesh, chart, kTolerance);
    EXPECT_EQ(chart.corner[0], Vec2::Zero());
    EXPECT_GT(chart.corner[1].x(), 0);
    EXPECT_EQ(chart.corner[1].y(), 0);
  }
}

TEST(FaceChart, AxesTieTheChartToSpace) {
  const TriMesh mesh = rough_torus();
  const FaceNormals normals(mesh);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const FaceChart chart = lay_out(mesh, f);
    const ChartAxes axes = chart_axes(mesh, f, normals[f]);
    const Vec3 origin = mesh.positions[mesh.faces[f][0]];
    for (int i = 1; i < 3; ++i) {
      const Vec3 expected = mesh.positions[mesh.faces[f][i]];
      EXPECT_TRUE(support::near(
          origin + axes.x * chart.corner[i].x() + axes.y * chart.corner[i].y(), expected, 1e-12));
    }
  }
}

TEST(FaceChart, BarycentricCoordinatesInvertPoint) {
  const TriMesh mesh = rough_torus();
  std::mt19937_64 random(3);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const FaceChart chart = lay_out(mesh, f);
    const Vec3 b = random_barycentric(random);
    EXPECT_TRUE(support::near(chart.barycentric(chart.point(b)), b, 1e-11));
  }
}

TEST(FaceChart, UnfoldsIsometricallyThereAndBack) {
  const TriMesh mesh = rough_torus();
  std::mt19937_64 random(5);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const FaceChart chart = lay_out(mesh, TriMesh::face_of(h));
    const FaceChart across = unfold(mesh, chart, h);
    ASSERT_EQ(across.face, TriMesh::face_of(mesh.twin[h]));
    expect_isometric(mesh, across, kTolerance);
    const int i = h % 3;
    const int j = mesh.twin[h] % 3;
    EXPECT_EQ(across.corner[j], chart.corner[(i + 1) % 3]) << "the shared edge stays where it is";
    EXPECT_EQ(across.corner[(j + 1) % 3], chart.corner[i]);
    const FaceChart back = unfold(mesh, across, mesh.twin[h]);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR((back.corner[k] - chart.corner[k]).norm(), 0, kTolerance);
    }
  }
}

/// How far along the displacement the point stays in the face, by bisection.
double last_step_inside(const FaceChart& chart, const Vec2& point, const Vec2& displacement) {
  double inside = 0;
  double outside = 1;
  for (int round = 0; round < 80; ++round) {
    const double middle = (inside + outside) / 2;
    const bool is_inside = chart.barycentric(point + middle * displacement).minCoeff() >= 0;
    (is_inside ? inside : outside) = middle;
  }
  return inside;
}

TEST(FindExit, AgreesWithBisection) {
  const TriMesh mesh = rough_torus();
  std::mt19937_64 random(11);
  int exits = 0;
  for (int round = 0; round < 4000; ++round) {
    const auto f = static_cast<Index>(random() % mesh.face_count());
    const FaceChart chart = lay_out(mesh, f);
    const Vec2 point = chart.point(random_barycentric(random));
    const Vec2 displacement =
        random_vector(random, 2 * edge_length(mesh, 3 * f) * static_cast<double>(random() % 2));
    const Vec3 end = chart.barycentric(point + displacement);
    const auto exit = find_exit(chart, point, displacement, {kNone, kNone});
    ASSERT_EQ(exit.has_value(), end.minCoeff() < 0);
    if (!exit) continue;
    ++exits;
    // Near a corner two edges are equally right; elsewhere there is one answer.
    const double step = last_step_inside(chart, point, displacement);
    EXPECT_NEAR(exit->step, step, 1e-10);
    ASSERT_EQ(TriMesh::face_of(exit->halfedge), f);
    const int i = exit->halfedge % 3;
    const Vec3 at = chart.barycentric(point + step * displacement);
    EXPECT_NEAR(at[(i + 2) % 3], 0, 1e-9) << "on the edge named";
    EXPECT_NEAR(at[(i + 1) % 3], exit->lambda, 1e-9);
  }
  EXPECT_GT(exits, 1000);
}

TEST(FindExit, NeverLeavesThroughAClosedEdge) {
  const TriMesh mesh = rough_torus();
  std::mt19937_64 random(13);
  for (int round = 0; round < 2000; ++round) {
    const auto h = static_cast<Index>(random() % mesh.halfedge_count());
    const FaceChart chart = lay_out(mesh, TriMesh::face_of(h));
    const int i = h % 3;
    const Vec2& a = chart.corner[i];
    const Vec2 edge = chart.corner[(i + 1) % 3] - a;
    // On the edge, up to rounding, and going in at any angle, even along the edge.
    const double lambda = std::uniform_real_distribution<double>(0.01, 0.99)(random);
    const double angle =
        round % 10 == 0 ? 0.0 : std::uniform_real_distribution<double>(0, M_PI)(random);
    const Vec2 in(std::cos(angle), std::sin(angle));
    const Vec2 displacement = 10 * (edge * in.x() + Vec2(-edge.y(), edge.x()) * in.y());
    const auto exit = find_exit(chart, a + lambda * edge, displacement, {h, kNone});
    ASSERT_TRUE(exit.has_value());
    EXPECT_NE(exit->halfedge, h);
    EXPECT_GE(exit->step, 0);
    EXPECT_LT(exit->step, 1);
    // From a corner only the edge opposite is a way out.
    const auto from_corner = find_exit(
        chart, a, 10 * (chart.point(random_barycentric(random)) - a) / 0.01, {h, TriMesh::prev(h)});
    ASSERT_TRUE(from_corner.has_value());
    EXPECT_EQ(from_corner->halfedge, TriMesh::next(h));
  }
}

struct Walk {
  FaceChart chart;
  Vec2 point;
  bool left_surface = false;
};

/// Walks straight ahead by unfolding face after face.
Walk walk(const TriMesh& mesh, FaceChart chart, Vec2 point, Vec2 displacement) {
  std::array<Index, 2> closed = {kNone, kNone};
  for (int guard = 0; guard < 10000; ++guard) {
    const auto exit = find_exit(chart, point, displacement, closed);
    if (!exit) return {chart, point + displacement};
    if (mesh.is_boundary(exit->halfedge)) return {chart, point, true};
    point += exit->step * displacement;
    displacement *= 1 - exit->step;
    chart = unfold(mesh, chart, exit->halfedge);
    closed = {mesh.twin[exit->halfedge], kNone};
  }
  ADD_FAILURE() << "the walk does not end";
  return {chart, point, true};
}

struct NamedDevelopment {
  const char* name;
  Development (*make)(std::uint64_t seed);
};

class Geodesics : public ::testing::TestWithParam<NamedDevelopment> {};

INSTANTIATE_TEST_SUITE_P(Developments, Geodesics,
                         ::testing::Values(NamedDevelopment{"cylinder", cylinder_development},
                                           NamedDevelopment{"cone", cone_development},
                                           NamedDevelopment{"cube_corner",
                                                            cube_corner_development}),
                         [](const auto& test) { return std::string(test.param.name); });

/// Whether the segment keeps inside the flat outline of the development: the surface's own edges
/// only, found by brute force over all boundary edges.
bool stays_inside(const Development& development, const Vec2& a, const Vec2& b) {
  const TriMesh& mesh = development.mesh;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    const Vec2& c = development.flat[mesh.from(h)];
    const Vec2& d = development.flat[mesh.to(h)];
    const bool apart_ab = cross2(b - a, c - a) * cross2(b - a, d - a) > 0;
    const bool apart_cd = cross2(d - c, a - c) * cross2(d - c, b - c) > 0;
    if (!apart_ab && !apart_cd) return false;
  }
  return true;
}

TEST_P(Geodesics, AreStraightLinesOfTheDevelopment) {
  const Development development = GetParam().make(17);
  const TriMesh& mesh = development.mesh;
  std::mt19937_64 random(19);
  int compared = 0;
  for (int round = 0; round < 2000; ++round) {
    const auto f = static_cast<Index>(random() % mesh.face_count());
    const Vec3 start = random_barycentric(random);
    FaceChart exact;  // the face where the development has it
    exact.face = f;
    for (int i = 0; i < 3; ++i) exact.corner[i] = development.flat[mesh.faces[f][i]];
    const Vec2 from = exact.point(start);
    const double length = std::uniform_real_distribution<double>(0.1, 3)(random);
    const Vec2 displacement = random_vector(random, length);
    // The same displacement in the chart's own position.
    const FaceChart chart = lay_out(mesh, f);
    const Vec2 base = (exact.corner[1] - exact.corner[0]).normalized();
    const Vec2 local(base.dot(displacement), cross2(base, displacement));
    const Walk end = walk(mesh, chart, chart.point(start), local);
    ASSERT_EQ(end.left_surface, !stays_inside(development, from, from + displacement));
    if (end.left_surface) continue;
    ++compared;
    const Vec3 b = end.chart.barycentric(end.point);
    Vec3 position = Vec3::Zero();
    for (int i = 0; i < 3; ++i) position += b[i] * mesh.positions[mesh.faces[end.chart.face][i]];
    // Rounding of some hundred unfoldings.
    EXPECT_TRUE(support::near(position, development.fold(from + displacement), 1e-10));
  }
  EXPECT_GT(compared, 200);
}

}  // namespace
}  // namespace strake
