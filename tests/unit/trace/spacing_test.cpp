#include "stages/trace/spacing.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "common/geometry/mesh_measures.h"
#include "stages/trace/line_flow.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

constexpr double kInfinite = 1e30;

TEST(SpacingFormula, ChordsOfACircleAreTheToleranceAway) {
  for (const double radius : {1e-4, 1.0, 37.0, 1e6}) {
    for (const double share : {1e-6, 1e-3, 0.1, 0.9, 1.0}) {
      const double tolerance = share * radius;
      const double d = spacing_for_curvature(1 / radius, tolerance, kInfinite);
      const double half = std::min(d / 2, radius);
      // Radius minus height, without cancellation.
      const double sagitta = half * half / (radius + std::sqrt(radius * radius - half * half));
      EXPECT_NEAR(sagitta / tolerance, 1, 1e-7);
    }
  }
}

TEST(SpacingFormula, IsClampedWhereTheCircleIsSmallerThanTheTolerance) {
  const double tolerance = 0.01;
  for (const double k : {1 / tolerance, 1.5 / tolerance, 2 / tolerance, 1e9}) {
    EXPECT_DOUBLE_EQ(spacing_for_curvature(k, tolerance, kInfinite), 2 * tolerance);
    EXPECT_DOUBLE_EQ(spacing_for_curvature(-k, tolerance, kInfinite), 2 * tolerance);
  }
  EXPECT_EQ(spacing_for_curvature(0, tolerance, 0.7), 0.7);
  EXPECT_EQ(spacing_for_curvature(1e-300, tolerance, 0.7), 0.7);
  EXPECT_EQ(spacing_for_curvature(2, tolerance, 0.05), 0.05) << "bounded by the largest";
}

TEST(SpacingFormula, FallsWithCurvatureAndGrowsWithTolerance) {
  const double tolerance = 0.003;
  double last = kInfinite;
  for (double k = 1e-6; k < 1e4; k *= 1.3) {
    const double d = spacing_for_curvature(k, tolerance, kInfinite);
    EXPECT_EQ(d, spacing_for_curvature(-k, tolerance, kInfinite));
    EXPECT_LE(d, last);
    EXPECT_GE(d, 2 * tolerance);
    last = d;
  }
  last = 0;
  for (double t = 1e-9; t < 1; t *= 1.3) {
    const double d = spacing_for_curvature(0.8, t, kInfinite);
    EXPECT_GT(d, last);
    last = d;
  }
}

/// A plane with random equal curvatures in both directions, on a scale that makes grading work.
struct RandomPlane {
  TriMesh mesh = sample_mesh(SampleKind::plane, 1200, 1);
  PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0.4, 0); });
  SpacingLimits limits;
  double tolerance = 1e-4;

  explicit RandomPlane(std::uint64_t seed) {
    std::mt19937_64 random(seed);
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
      field.k_min[w] = std::pow(10.0, std::uniform_real_distribution<double>(-3, 2.5)(random));
      field.k_max[w] = field.k_min[w];
    }
    limits.smallest = 1e-6;
    limits.largest = 0.5;
  }

  [[nodiscard]] double ungraded(Index w) const {
    return spacing_for_curvature(field.k_min[w], tolerance, limits.largest);
  }
};

TEST(Grading, IsTheLargestFunctionBelowTheWantedOneWithThatSlope) {
  const RandomPlane plane(1);
  const TriMesh& mesh = plane.mesh;
  const double slope = plane.limits.gradation;
  // By the definition: relax every edge until nothing changes.
  std::vector<double> expected(mesh.wedge_count());
  for (Index w = 0; w < mesh.wedge_count(); ++w) expected[w] = plane.ungraded(w);
  for (bool changed = true; changed;) {
    changed = false;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index a = mesh.wedge_of(h);
      const Index b = mesh.wedge_of(TriMesh::next(h));
      for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
        const double reach = expected[from] + slope * edge_length(mesh, h);
        if (reach < expected[to] * (1 - 1e-14)) {
          expected[to] = reach;
          changed = true;
        }
      }
    }
  }
  const Spacing spacing =
      SpacingModel(mesh, plane.field).for_tolerance(plane.tolerance, plane.limits);
  Index graded = 0;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    EXPECT_NEAR(spacing.along[w] / expected[w], 1, 1e-12);
    EXPECT_NEAR(spacing.across[w] / expected[w], 1, 1e-12);
    graded += expected[w] < 0.99 * plane.ungraded(w);
  }
  EXPECT_GT(graded, mesh.wedge_count() / 2) << "the case is to need grading";
}

TEST(Grading, BoundsTheSlopeOnEveryEdgeAndTheAspectRatio) {
  RandomPlane plane(2);
  const TriMesh& mesh = plane.mesh;
  std::mt19937_64 random(3);
  for (double& k : plane.field.k_max) k *= 1 + static_cast<double>(random() % 300);
  const Spacing spacing =
      SpacingModel(mesh, plane.field).for_tolerance(plane.tolerance, plane.limits);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index a = mesh.wedge_of(h);
    const Index b = mesh.wedge_of(TriMesh::next(h));
    const double bound = plane.limits.gradation * edge_length(mesh, h) * (1 + 1e-12);
    EXPECT_LE(std::abs(spacing.along[a] - spacing.along[b]), bound);
    EXPECT_LE(std::abs(spacing.across[a] - spacing.across[b]), bound);
  }
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const auto [small, large] = std::minmax(spacing.along[w], spacing.across[w]);
    EXPECT_LE(large, plane.limits.aspect_ratio * small * (1 + 1e-12));
    EXPECT_LE(large, plane.limits.largest);
    EXPECT_GE(small, plane.limits.smallest);
    // Never above what curvature along the arm asks for.
    EXPECT_LE(spacing.along[w],
              spacing_for_curvature(plane.field.k_min[w], plane.tolerance, plane.limits.largest));
    EXPECT_LE(spacing.across[w],
              spacing_for_curvature(plane.field.k_max[w], plane.tolerance, plane.limits.largest));
  }
}

// Almost all keys wait in one interval of the queue there: taken out in any order but that of their
// values, each would be lowered, and taken out again, more often than there are keys.
TEST(Grading, EndsWhereMostOfTheMeshIsTiny) {
  constexpr double kScale = 1e-6;
  SampleOptions options;
  options.faces = 60000;
  PolyMesh tiny = make_sample(SampleKind::plane, options);
  for (Vec3& p : tiny.positions) p *= kScale;
  const auto first = tiny.vertex_count();
  for (const Vec3& p : {Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, 1, 0)}) tiny.positions.push_back(p);
  tiny.add_face(std::array<Index, 3>{first, first + 1, first + 2});
  const TriMesh mesh = support::plain_tri_mesh(tiny);
  PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0.4, 0); });
  field.k_min[0] = field.k_max[0] = 1e9;  // from there a wave goes over all of it
  SpacingLimits limits;
  limits.smallest = 1e-12;
  limits.largest = 0.5;
  const Spacing spacing = SpacingModel(mesh, field).for_tolerance(1e-4 * kScale, limits);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const double step =
        spacing.along[mesh.wedge_of(TriMesh::next(h))] - spacing.along[mesh.wedge_of(h)];
    EXPECT_LE(std::abs(step), limits.gradation * edge_length(mesh, h) * (1 + 1e-12));
  }
}

TEST(Grading, DoesNotDependOnWhichArmOfTheCrossIsNamed) {
  RandomPlane plane(4);
  std::mt19937_64 random(5);
  for (double& k : plane.field.k_max) k *= 1 + static_cast<double>(random() % 30);
  const Spacing straight =
      SpacingModel(plane.mesh, plane.field).for_tolerance(plane.tolerance, plane.limits);
  PrincipalField turned = plane.field;
  turn_crosses(turned, 6);
  const Spacing spacing =
      SpacingModel(plane.mesh, turned).for_tolerance(plane.tolerance, plane.limits);
  for (Index w = 0; w < plane.mesh.wedge_count(); ++w) {
    const bool same = std::abs(turned.cross[w].dot(plane.field.cross[w])) > 0.5;
    EXPECT_NEAR((same ? spacing.along : spacing.across)[w] / straight.along[w], 1, 1e-10);
    EXPECT_NEAR((same ? spacing.across : spacing.along)[w] / straight.across[w], 1, 1e-10);
  }
}

/// Two squares that meet in a right angle along the x axis, the second one hanging down.
TriMesh bent_sheet() {
  constexpr Index kCells = 8;
  PolyMesh soup;
  for (Index j = -kCells; j <= kCells; ++j) {
    for (Index i = 0; i <= kCells; ++i) {
      const double x = double(i) / kCells;
      const double y = double(j) / kCells;
      soup.positions.emplace_back(x, std::max(y, 0.0), std::min(y, 0.0));
    }
  }
  for (Index j = 0; j < 2 * kCells; ++j) {
    for (Index i = 0; i < kCells; ++i) {
      const Index v = j * (kCells + 1) + i;
      soup.add_face(std::array<Index, 3>{v, v + 1, v + kCells + 2});
      soup.add_face(std::array<Index, 3>{v, v + kCells + 2, v + kCells + 1});
    }
  }
  return support::import_tri_mesh(soup);
}

TEST(Grading, TiesDistancesAlongAFeatureOnItsTwoSidesOnly) {
  const TriMesh mesh = bent_sheet();
  PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3::UnitX(); });
  SpacingLimits limits;
  limits.smallest = 1e-6;
  limits.largest = 0.05;
  limits.gradation = 0.01;  // nothing reaches far
  const double tolerance = 1e-4;
  const double fine = 0.8 * limits.largest;
  const double k = 2 * tolerance / (fine * fine / 4 + tolerance * tolerance);  // spacing `fine`
  const auto is_upper = [&](Index w) { return std::abs(field.normal[w].z()) > 0.5; };
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    if (is_upper(w)) field.k_min[w] = field.k_max[w] = k;
  }
  turn_crosses(field, 8);
  const Spacing spacing = SpacingModel(mesh, field).for_tolerance(tolerance, limits);
  const auto physical = [&](Index w, const Vec3& direction) {
    return std::abs(field.cross[w].dot(direction)) > 0.5 ? spacing.along[w] : spacing.across[w];
  };
  Index creases = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] == 0) continue;
    ++creases;
    for (const Index corner : {h, TriMesh::next(h)}) {
      const Index w = mesh.wedge_of(corner);
      const Vec3 other = field.normal[w].cross(Vec3::UnitX());
      EXPECT_NEAR(physical(w, Vec3::UnitX()), fine, 1e-9) << "tied";
      EXPECT_NEAR(physical(w, other), is_upper(w) ? fine : limits.largest, 1e-9) << "free";
    }
  }
  EXPECT_GT(creases, 0);
}

/// Lines part on one side of a feature and run side by side on the other one.
TEST(LineFlow, ChangesDistancesBesideAFeatureByTheSame) {
  const TriMesh mesh = bent_sheet();
  const PrincipalField field = field_along(
      mesh, [](const Vec3& p) { return p.y() > 0 ? Vec3(1, 0.5 * p.y(), 0) : Vec3(1, 0, 0); });
  constexpr double kDistance = 0.2;
  Spacing spacing;
  spacing.along.assign(mesh.wedge_vertex.size(), kDistance);
  spacing.across = spacing.along;
  follow_lines(mesh, field, ArmBonds(mesh, field), 5, spacing);
  double change = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] == 0) continue;
    const Index here = mesh.wedge_of(h);
    const Index there = mesh.wedge_of(TriMesh::next(mesh.twin[h]));
    ASSERT_NE(here, there);
    EXPECT_NEAR(spacing.along[here], spacing.along[there], 1e-12);
    change = std::max(change, std::abs(spacing.along[here] / kDistance - 1));
  }
  EXPECT_GT(change, 0.001) << "there is to be something to share";
}

/// A plane with one curvature everywhere in the direction across its field, and none along it.
Spacing spacing_for(double curvature, double tolerance, const SpacingLimits& limits) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 500);
  PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0, 0); });
  std::fill(field.k_max.begin(), field.k_max.end(), curvature);
  return SpacingModel(mesh, field).for_tolerance(tolerance, limits);
}

TEST(Needles, AreNotResolved) {
  SpacingLimits limits;
  limits.smallest = 1e-4;
  limits.largest = 0.05;
  // Of this radius, or thicker than the tolerance, they count as round.
  const double tolerance = 2e-4;
  for (const double share : {0.01, 0.5, 1.0}) {
    EXPECT_DOUBLE_EQ(spacing_for(share / tolerance, tolerance, limits).across.front(),
                     spacing_for_curvature(share / tolerance, tolerance, limits.largest));
  }
  for (const double share : {2.0, 5.0, 10.0}) {  // thinner: wider by the square
    EXPECT_NEAR(spacing_for(share / tolerance, tolerance, limits).across.front(),
                share * share * 2 * tolerance, 1e-12);
  }
  EXPECT_EQ(spacing_for(1e9, tolerance, limits).across.front(), limits.largest);
  // A coarse tolerance does not make needles of what is bent more than that.
  EXPECT_DOUBLE_EQ(spacing_for(1000, 0.02, limits).across.front(),
                   spacing_for_curvature(1000, 0.02, limits.largest));
}

TEST(Bounds, AreNotBelowTheSmallestDistance) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 500);
  const PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3(1, 0, 0); });
  SpacingLimits limits;
  limits.smallest = 1e-4;
  limits.largest = 0.05;
  for (const double length : {0.0, 1e-9, 1e-3}) {
    SpacingModel model(mesh, field);
    model.bound_along({0}, length);
    const Spacing spacing = model.for_tolerance(1e-4, limits);
    const double least = std::min(*std::min_element(spacing.along.begin(), spacing.along.end()),
                                  *std::min_element(spacing.across.begin(), spacing.across.end()));
    EXPECT_DOUBLE_EQ(least, std::max(length, limits.smallest));
  }
}

TEST(PredictedVertices, IsTheAreaInCells) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 800);
  Spacing spacing;
  spacing.along.assign(mesh.wedge_count(), 0.04);
  spacing.across.assign(mesh.wedge_count(), 0.1);
  const double area = 4 * kPlaneHalfSize * kPlaneHalfSize;
  EXPECT_NEAR(predicted_vertices(wedge_areas(mesh), spacing), area / (0.04 * 0.1), 1e-6);
}

PrincipalField field_of_torus(const TriMesh& mesh) {
  PrincipalField field = field_along(mesh, [](const Vec3& p) { return Vec3(-p.y(), p.x(), 0); });
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3& p = mesh.positions[mesh.wedge_vertex[w]];
    const double rho = p.head<2>().norm();
    field.k_max[w] = 1 / kTorusMinorRadius;
    field.k_min[w] = (rho - kTorusMajorRadius) / (kTorusMinorRadius * rho);
  }
  return field;
}

TEST(SpacingForCount, ToleranceFallsWithTheCountAndPredictsIt) {
  const TriMesh mesh = sample_mesh(SampleKind::torus, 4000);
  const PrincipalField field = field_of_torus(mesh);
  const SpacingModel model(mesh, field);
  SpacingLimits limits;
  limits.smallest = 1e-4 * mesh.diagonal;
  limits.largest = 0.3 * mesh.diagonal;
  double last = kInfinite;
  for (const double count : {100.0, 300.0, 1000.0, 3000.0, 10000.0, 50000.0}) {
    const auto [tolerance, spacing] = model.for_count(count, limits);
    EXPECT_LT(tolerance, last);
    last = tolerance;
    EXPECT_NEAR(predicted_vertices(model.areas(), spacing) / count, 1, 0.021);
    const Spacing again = model.for_tolerance(tolerance, limits);
    EXPECT_EQ(spacing.along, again.along);
    EXPECT_EQ(spacing.across, again.across);
  }
}

// As on a needle, which has less area than its length suggests.
TEST(SpacingForCount, ACountThatTheSmallestDistancesDoNotGiveLeavesThemAFactor) {
  const TriMesh mesh = sample_mesh(SampleKind::torus, 4000);
  const PrincipalField field = field_of_torus(mesh);
  const SpacingModel model(mesh, field);
  SpacingLimits limits;
  limits.smallest = 0.1 * mesh.diagonal;
  limits.largest = 0.5 * mesh.diagonal;
  const auto [tolerance, spacing] = model.for_count(1e5, limits);
  const double vertices = predicted_vertices(model.areas(), spacing);
  EXPECT_LT(vertices, 1e3);
  limits.scale = 2;
  const Spacing doubled = model.for_tolerance(tolerance, limits);
  EXPECT_LT(predicted_vertices(model.areas(), doubled), 0.6 * vertices);  // all of them before
}

}  // namespace
}  // namespace strake
