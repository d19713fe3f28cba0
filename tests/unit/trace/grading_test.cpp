#include "stages/trace/grading.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "stages/trace/spacing.h"
#include "tests/support/import_support.h"
#include "tests/unit/trace/fields.h"

namespace strake {
namespace {

constexpr double kGradation = 0.25;

Spacing random_spacing(const TriMesh& mesh) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> log_distance(-6, -1);
  Spacing spacing;
  for (auto* distances : {&spacing.along, &spacing.across}) {
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
      distances->push_back(std::exp(log_distance(random)));
    }
  }
  return spacing;
}

double& value_of(Spacing& spacing, Index key) {
  return key % 2 == 0 ? spacing.along[key / 2] : spacing.across[key / 2];
}

/// Lowers what is above a bound, in the order of keys, until nothing is.
Spacing graded_by_sweeps(const TriMesh& mesh, const ArmBonds& bonds, Spacing spacing) {
  std::vector<double> aspect;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const auto [small, large] = std::minmax(spacing.along[w], spacing.across[w]);
    aspect.push_back(std::max(2.0, large / small));
  }
  bool any = true;
  const auto lower = [&](Index key, double bound) {
    double& value = value_of(spacing, key);
    if (!(bound < value)) return;
    value = bound;
    any = true;
  };
  while (any) {
    any = false;
    for (Index key = 0; key < 2 * mesh.wedge_count(); ++key) {
      const double value = value_of(spacing, key);
      lower(key ^ 1, aspect[key / 2] * value);
      for (Index at = bonds.first(key / 2); at < bonds.first(key / 2 + 1); ++at) {
        lower(bonds.bonded(at, key), value + kGradation * bonds.length(at, key / 2));
      }
      bonds.for_each_tied(key, [&](Index other) { lower(other, value); });
    }
  }
  return spacing;
}

TEST(GradeSpacing, GivesTheLargestDistancesWithinAllBoundsOnAnyNumberOfThreads) {
  SampleOptions part;  // with feature lines
  part.faces = 20000;
  const TriMesh mesh = support::import_tri_mesh(make_sample(SampleKind::part, part));
  ASSERT_TRUE(std::ranges::any_of(mesh.is_feature, [](auto feature) { return feature != 0; }));
  PrincipalField field = field_along(mesh, [](const Vec3& p) { return Vec3(-p.y(), p.x(), 1); });
  turn_crosses(field, 3);
  const ArmBonds bonds(mesh, field);
  const Spacing wanted = random_spacing(mesh);
  const Spacing swept = graded_by_sweeps(mesh, bonds, wanted);
  EXPECT_NE(swept.along, wanted.along);
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    Spacing graded = wanted;
    grade_spacing(bonds, kGradation, graded);
    EXPECT_EQ(graded.along, swept.along);
    EXPECT_EQ(graded.across, swept.across);
  }
}

}  // namespace
}  // namespace strake
