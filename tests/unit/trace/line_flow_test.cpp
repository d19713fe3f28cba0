#include "stages/trace/line_flow.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "common/geometry/mesh_measures.h"
#include "tests/support/chain.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

constexpr double kCell = 0.1;
constexpr double kFlowCells = 5;

using Distance = std::function<double(const Vec3&)>;

const Vec3& place(const TriMesh& mesh, Index w) { return mesh.positions[mesh.wedge_vertex[w]]; }

/// Distances of a field that is not turned: `between` of the lines along its cross, kCell of the
/// others.
Spacing spacing_with(const TriMesh& mesh, const Distance& between) {
  Spacing spacing;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    spacing.along.push_back(kCell);
    spacing.across.push_back(between(place(mesh, w)));
  }
  return spacing;
}

Spacing followed(const TriMesh& mesh, const PrincipalField& field, Spacing spacing) {
  follow_lines(mesh, field, ArmBonds(mesh, field), kFlowCells, spacing);
  return spacing;
}

/// Lines along x on [-1, 1]^2 whose distances swing by a hundredth.
/// \param direction  of the wave
/// \return what is left of that wave, from 0 to 1
double kept_of_wave(const Vec3& direction, int half_waves) {
  const TriMesh mesh = sample_mesh(SampleKind::plane, 20000);
  const PrincipalField field = field_along(mesh, [](const Vec3&) { return Vec3::UnitX(); });
  const auto wave = [&](const Vec3& p) {
    return std::cos(half_waves * M_PI / 2 * (p.dot(direction) + kPlaneHalfSize));
  };
  const Spacing before =
      spacing_with(mesh, [&](const Vec3& p) { return kCell * std::exp(0.01 * wave(p)); });
  const Spacing after = followed(mesh, field, before);
  const std::vector<double> areas = wedge_areas(mesh);
  double kept = 0;
  double had = 0;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const double weight = areas[w] * wave(place(mesh, w));
    kept += weight * std::log(after.across[w] / kCell);
    had += weight * std::log(before.across[w] / kCell);
    EXPECT_NEAR(after.along[w] / kCell, 1, 2e-4) << "nothing to follow";
  }
  return kept / had;
}

TEST(LineFlow, ChangesAlongLinesFallByTheirWavelength) {
  for (const int half_waves : {1, 2, 4}) {
    // Of x^2 + (L d(s + x))^2 the least, for a wave of number k: 1 / (1 + (L k)^2) stays.
    const double phase = kFlowCells * kCell * half_waves * M_PI / 2;
    EXPECT_NEAR(kept_of_wave(Vec3::UnitX(), half_waves), 1 / (1 + phase * phase), 0.02)
        << half_waves;
  }
}

TEST(LineFlow, ChangesAcrossLinesStay) {
  for (const int half_waves : {1, 4}) {
    EXPECT_NEAR(kept_of_wave(Vec3::UnitY(), half_waves), 1, 0.02) << half_waves;
  }
}

/// Rays from a point outside of the plane.
struct Rays {
  explicit Rays(double distance)
      : source(-distance, 0, 0),
        field(field_along(mesh, [&](const Vec3& p) { return p - source; })) {}

  [[nodiscard]] double radius(const Vec3& p) const { return (p - source).norm(); }

  Vec3 source;
  TriMesh mesh = sample_mesh(SampleKind::plane, 20000);
  PrincipalField field;
};

TEST(LineFlow, LeavesDistancesOfLinesThatPart) {
  const Rays rays(3);
  const Spacing before =
      spacing_with(rays.mesh, [&](const Vec3& p) { return kCell / 3 * rays.radius(p); });
  const Spacing after = followed(rays.mesh, rays.field, before);
  for (Index w = 0; w < rays.mesh.wedge_count(); ++w) {
    EXPECT_NEAR(after.across[w] / before.across[w], 1, 0.01);
    EXPECT_NEAR(after.along[w] / before.along[w], 1, 0.01) << "circles keep their distances";
  }
}

TEST(LineFlow, LetsDistancesGrowWhereLinesPart) {
  const Rays rays(30);
  const Spacing after =
      followed(rays.mesh, rays.field, spacing_with(rays.mesh, [](const Vec3&) { return kCell; }));
  // Of x^2 + (L (dx - g))^2 the least on an interval, for the constant slope g = 1 / radius.
  const double length = kFlowCells * kCell;
  const double most = length / 30;
  for (Index w = 0; w < rays.mesh.wedge_count(); ++w) {
    const Vec3& p = place(rays.mesh, w);
    if (std::abs(p.y()) > 0.8) continue;  // some rays leave the plane on the sides
    const double expected = most * std::sinh(p.x() / length) / std::cosh(kPlaneHalfSize / length);
    EXPECT_NEAR(std::log(after.across[w] / kCell), expected, 0.1 * most);
  }
}

TEST(LineFlow, ChangesByAQuarterAtMost) {
  const Rays rays(1.01);
  const Spacing after =
      followed(rays.mesh, rays.field, spacing_with(rays.mesh, [](const Vec3&) { return kCell; }));
  const auto [least, largest] = std::ranges::minmax(after.across);
  EXPECT_NEAR(kCell / least, 1.25, 1e-9);
  EXPECT_LE(largest / kCell, 1.25 + 1e-9);
}

TEST(LineFlow, DoesNotDependOnWhichArmOfTheCrossIsNamed) {
  const Rays rays(3);
  const Spacing before = spacing_with(
      rays.mesh, [](const Vec3& p) { return kCell * (1 + 0.1 * std::sin(4 * p.x() + p.y())); });
  const Spacing straight = followed(rays.mesh, rays.field, before);
  PrincipalField turned = rays.field;
  turn_crosses(turned, 6);
  const auto is_same = [&](Index w) {
    return std::abs(turned.cross[w].dot(rays.field.cross[w])) > 0.5;
  };
  Spacing spacing = before;
  for (Index w = 0; w < rays.mesh.wedge_count(); ++w) {
    if (!is_same(w)) std::swap(spacing.along[w], spacing.across[w]);
  }
  spacing = followed(rays.mesh, turned, spacing);
  for (Index w = 0; w < rays.mesh.wedge_count(); ++w) {
    if (!is_same(w)) std::swap(spacing.along[w], spacing.across[w]);
    EXPECT_NEAR(spacing.along[w] / straight.along[w], 1, 1e-6);
    EXPECT_NEAR(spacing.across[w] / straight.across[w], 1, 1e-6);
  }
}

/// Ends of lines beside other lines, over crossings of edges, on surfaces of four seeds.
double share_of_ends(const support::Prepared& surface, double cells) {
  double ends = 0;
  double crossings = 0;
  TraceOptions options;
  options.vertices = 1500;
  options.line_flow = cells;
  for (options.seed = 1; options.seed <= 4; ++options.seed) {
    const LineSet lines = support::trace(surface, options);
    for (Index l = 0; l < lines.line_count(); ++l) {
      ends += static_cast<double>(lines.start_reason[l] == LineEnd::proximity);
      ends += static_cast<double>(lines.end_reason[l] == LineEnd::proximity);
    }
    crossings += static_cast<double>(lines.points.size());
  }
  return ends / crossings;
}

TEST(LineFlow, MakesFewerLinesEnd) {
  SampleOptions options;
  options.faces = 12000;
  const support::Prepared surface = support::prepare(make_sample(SampleKind::ellipsoid, options));
  EXPECT_LT(share_of_ends(surface, kFlowCells), 0.9 * share_of_ends(surface, 0));
}

}  // namespace
}  // namespace strake
