#include "stages/prolong/prolong.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/mesh_measures.h"
#include "stages/prolong/stage.h"
#include "tests/support/import_support.h"
#include "tests/unit/coarsen/coarse_samples.h"

namespace strake {
namespace {

using coarsen_test::coarse_field;
using coarsen_test::coarsened;
using coarsen_test::sample;

/// A field on a coarser mesh, and what becomes of it on the mesh.
struct Prolonged {
  TriMesh mesh;
  TriMesh coarse;
  PrincipalField before;
  PrincipalField after;
};

Prolonged prolonged(TriMesh mesh, std::int64_t coarse_vertices) {
  Prolonged result;
  result.coarse = coarsened(mesh, coarse_vertices);
  result.before = coarse_field(mesh, result.coarse);
  result.after = prolong_field(mesh, result.coarse, result.before);
  result.mesh = std::move(mesh);
  return result;
}

/// Degrees between two directions whose sign is free.
double angle_deg(const Vec3& a, const Vec3& b) {
  return std::acos(std::clamp(std::abs(a.dot(b)), 0.0, 1.0)) * 180 / std::numbers::pi;
}

TEST(ProlongField, StaysAsItIsAtWedgesOfTheCoarserMesh) {
  const Prolonged part = prolonged(sample(SampleKind::part, 9000), 1500);
  EXPECT_EQ(part.after.mesh_id, part.mesh.id);
  EXPECT_EQ(part.after.cross_extended, part.before.cross_extended);
  ASSERT_EQ(part.after.face_confidence.size(), part.mesh.faces.size());
  for (Index w = 0; w < part.coarse.wedge_count(); ++w) {
    const Index parent = part.coarse.parent_wedge[w];
    EXPECT_EQ(part.after.normal[parent], part.before.normal[w]);
    EXPECT_EQ(part.after.t_min[parent], part.before.t_min[w]);
    EXPECT_EQ(part.after.cross[parent], part.before.cross[w]);
    EXPECT_EQ(part.after.k_min[parent], part.before.k_min[w]);
    EXPECT_EQ(part.after.k_max[parent], part.before.k_max[w]);
    EXPECT_EQ(part.after.wedge_confidence[parent], part.before.wedge_confidence[w]);
  }
}

// Around the tube the curvature is 1 / r everywhere, and the lines of it are known.
TEST(ProlongField, HasTheCurvatureOfATorusBetweenThem) {
  const Prolonged torus = prolonged(sample(SampleKind::torus, 40000), 2500);
  // Relative. Between directions that differ by some degrees interpolation loses up to 1 % more.
  const auto largest_error = [](const std::vector<double>& k_max) {
    double largest = 0;
    for (const double k : k_max) largest = std::max(largest, std::abs(k * kTorusMinorRadius - 1));
    return largest;
  };
  EXPECT_LT(largest_error(torus.before.k_max), 0.08);
  EXPECT_LT(largest_error(torus.after.k_max), largest_error(torus.before.k_max) + 0.01);
  const auto mean = [](const std::vector<double>& k_max) {
    return std::accumulate(k_max.begin(), k_max.end(), 0.0) / static_cast<double>(k_max.size());
  };
  EXPECT_NEAR(mean(torus.after.k_max) / mean(torus.before.k_max), 1, 0.005);
  std::vector<double> angles;
  for (Index w = 0; w < torus.mesh.wedge_count(); ++w) {
    const Vec3 p = torus.mesh.positions[torus.mesh.wedge_vertex[w]] + torus.mesh.origin;
    const Vec3& n = torus.after.normal[w];
    const Vec3& t_min = torus.after.t_min[w];
    EXPECT_NEAR(n.norm(), 1, 1e-12);
    EXPECT_NEAR(t_min.norm(), 1, 1e-12);
    EXPECT_NEAR(t_min.dot(n), 0, 1e-12);
    EXPECT_NEAR(torus.after.cross[w].dot(n), 0, 1e-12);
    EXPECT_LE(std::abs(torus.after.k_min[w]), std::abs(torus.after.k_max[w]));
    const Vec3 around_axis = Vec3(-p.y(), p.x(), 0).normalized();
    angles.push_back(angle_deg(t_min, around_axis));
  }
  std::ranges::sort(angles);
  EXPECT_LT(angles[angles.size() * 99 / 100], 3);
}

// The other side is often nearer than what the coarser mesh misses.
TEST(ProlongField, StaysOnItsSideOfAShell) {
  const Prolonged shell =
      prolonged(support::import_tri_mesh(coarsen_test::thin_shell(0.004)), 1200);
  for (Index w = 0; w < shell.mesh.wedge_count(); ++w) {
    const Vec3 p = shell.mesh.positions[shell.mesh.wedge_vertex[w]] + shell.mesh.origin;
    const double wanted = p.dot(shell.after.normal[w]) > 0 ? 1 : -1;
    EXPECT_NEAR(shell.after.k_max[w], wanted, 0.1) << w;
    EXPECT_NEAR(shell.after.k_min[w], wanted, 0.1) << w;
  }
}

TEST(ProlongField, RefusesGuides) {
  Prolonged part = prolonged(sample(SampleKind::part, 8000), 1500);
  part.before.guides.offsets = {0, 1};
  part.before.guides.face = {0};
  EXPECT_THROW(prolong_field(part.mesh, part.coarse, part.before), UsageError);
}

Inputs inputs_of(const TriMesh& mesh, const TriMesh& coarse, const PrincipalField& field) {
  Inputs inputs;
  inputs.add("mesh", {std::make_shared<Value>(mesh), "mesh.hdf"});
  inputs.add("coarse", {std::make_shared<Value>(coarse), "coarse.hdf"});
  inputs.add("coarse-field", {std::make_shared<Value>(field), "coarse-field.hdf"});
  return inputs;
}

TEST(ProlongStage, RefusesWhatDoesNotBelongTogether) {
  const Prolonged part = prolonged(sample(SampleKind::part, 8000), 1500);
  SilentObserver observer;
  Inputs right = inputs_of(part.mesh, part.coarse, part.before);
  EXPECT_NO_THROW(run_stage(prolong_stage(), right, observer));
  Inputs no_parent = inputs_of(part.mesh, part.mesh, part.after);
  EXPECT_THROW(run_stage(prolong_stage(), no_parent, observer), PreconditionError);
  Inputs field_of_mesh = inputs_of(part.mesh, part.coarse, part.after);
  EXPECT_THROW(run_stage(prolong_stage(), field_of_mesh, observer), PreconditionError);
  TriMesh damaged = part.coarse;
  damaged.parent_wedge[0] = part.mesh.wedge_count();
  Inputs out_of_range = inputs_of(part.mesh, damaged, part.before);
  EXPECT_THROW(run_stage(prolong_stage(), out_of_range, observer), InputError);
}

}  // namespace
}  // namespace strake
