#include "stages/smooth/cross_field.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "common/geometry/angles.h"
#include "common/geometry/conjugate_gradients.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"
#include "stages/smooth/smooth.h"
#include "tests/support/analytic_surfaces.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/smooth/cross_angles.h"

namespace strake {
namespace {

const double kStiffness = SmoothOptions{}.field_stiffness;

/// [F] The turns that the cross makes around each face: quarters.
std::vector<double> face_indices(const TriMesh& mesh, const PrincipalField& field) {
  const FaceNormals normals(mesh);
  std::vector<double> indices(static_cast<std::size_t>(mesh.face_count()));
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const TangentFrame frame = tangent_frame(normals[f]);
    std::array<std::complex<double>, 3> power;
    for (int i = 0; i < 3; ++i) {
      const Index w = mesh.face_wedges[f][i];
      power[i] = cross_power(
          frame.tangent_from_world(rotate_between(field.normal[w], normals[f], field.cross[w])));
    }
    for (int i = 0; i < 3; ++i) {
      indices[f] += std::arg(power[(i + 1) % 3] * std::conj(power[i])) / (8 * M_PI);
    }
  }
  return indices;
}

double index_sum(const TriMesh& mesh, const PrincipalField& field) {
  const std::vector<double> indices = face_indices(mesh, field);
  return std::accumulate(indices.begin(), indices.end(), 0.0);
}

PolyMesh noisy_sample(SampleKind kind, double sigma) {
  SampleOptions options;
  options.faces = 12000;
  PolyMesh soup = make_sample(kind, options);
  std::mt19937_64 random(3);
  std::normal_distribution<double> noise(0, sigma);
  for (Vec3& p : soup.positions) p += Vec3(noise(random), noise(random), noise(random));
  return soup;
}

/// A tube with its exact field; the side of the open cylinder has no features.
class CrossOnATube : public ::testing::Test {
 protected:
  CrossOnATube() {
    SampleOptions options;
    options.faces = 8000;
    mesh_ = support::plain_tri_mesh(make_sample(SampleKind::open_cylinder, options));
    const auto count = static_cast<std::size_t>(mesh_.wedge_count());
    field_.normal = wedge_normals(mesh_, FaceNormals(mesh_));
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
      const Vec3& n = field_.normal[w];
      field_.t_min.push_back((Vec3::UnitZ() - n * n.z()).normalized());
    }
    field_.k_min.assign(count, 0);
    field_.k_max.assign(count, 1 / kCylinderRadius);
    field_.wedge_confidence.assign(count, 1);
  }

  void turn(Index w, double angle) {
    const Vec3 across = field_.normal[w].cross(field_.t_min[w]);
    field_.t_min[w] = std::cos(angle) * field_.t_min[w] + std::sin(angle) * across;
  }
  void extend() { extend_cross_field(mesh_, wedge_graph(mesh_), kStiffness, {}, field_); }
  [[nodiscard]] double error(Index w) const { return angle_to_cross(field_, w, Vec3::UnitZ()); }

  TriMesh mesh_;
  PrincipalField field_;
};

TEST_F(CrossOnATube, KeepsDirectionsThatAgree) {
  extend();
  for (Index w = 0; w < mesh_.wedge_count(); ++w) EXPECT_LT(error(w), 0.5 * kDegree);
}

/// A patch of directions that contradict all around them is given up; least squares would turn the
/// field half-way.
TEST_F(CrossOnATube, GivesUpWhatContradictsItsSurroundings) {
  const double reach = 0.1;
  for (Index w = 0; w < mesh_.wedge_count(); ++w) {
    const Vec3& p = mesh_.positions[mesh_.wedge_vertex[w]];
    if ((p - Vec3(kCylinderRadius, 0, 0)).norm() < reach) turn(w, 40 * kDegree);
  }
  extend();
  for (Index w = 0; w < mesh_.wedge_count(); ++w) EXPECT_LT(error(w), 10 * kDegree);
}

/// Where the surface is bent and the directions agree over several times the length over which the
/// field evens out, they hold, though others run around them.
TEST_F(CrossOnATube, FollowsWidePatches) {
  const double length = std::sqrt(mesh_.diagonal * kCylinderRadius / kStiffness);
  for (Index w = 0; w < mesh_.wedge_count(); ++w) {
    if (mesh_.positions[mesh_.wedge_vertex[w]].x() > 0) turn(w, 40 * kDegree);
  }
  extend();
  for (Index w = 0; w < mesh_.wedge_count(); ++w) {
    const Vec3& p = mesh_.positions[mesh_.wedge_vertex[w]];
    if (std::abs(p.x()) < 6 * length || std::abs(p.z()) > kCylinderHalfHeight - 6 * length)
      continue;
    EXPECT_NEAR(error(w), p.x() > 0 ? 40 * kDegree : 0, 2 * kDegree);
  }
}

/// [Poincare and Hopf] The indices of a direction field on a closed surface add up to its Euler
/// characteristic. With a fair mesh every face sees all of its own turn.
TEST(CrossField, IndicesAddUpToTheEulerCharacteristic) {
  const support::Prepared torus = support::prepare(noisy_sample(SampleKind::torus, 1e-3));
  EXPECT_NEAR(index_sum(torus.mesh, torus.field), 0, 1e-6);
  for (const SampleKind kind : {SampleKind::sphere, SampleKind::ellipsoid}) {
    const support::Prepared prepared = support::prepare(noisy_sample(kind, 1e-3));
    EXPECT_NEAR(index_sum(prepared.mesh, prepared.field), 2, 1e-6);
  }
}

/// [Bethuel, Brezis and Helein 1994] On a disk with d singular places their energy is least where
/// they lie evenly on a circle of the radius r with r^(2 d) = (d - 1) / (3 d - 1): with four, and
/// crosses along the rim, 0.85 of that of the disk. A harmonic field has all of them in the middle;
/// a few rounds of spreading come most of the way.
TEST(CrossField, HasTheSingularPlacesOfADiskWhereTheyBelong) {
  SampleOptions options;
  options.faces = 20000;
  const support::Prepared cylinder = support::prepare(make_sample(SampleKind::cylinder, options));
  const std::vector<double> indices = face_indices(cylinder.mesh, cylinder.field);
  const FaceNormals normals(cylinder.mesh);
  const double best = std::pow(3.0 / 11, 1.0 / 8);
  std::array<std::vector<double>, 2> angles;  // of the places on the lower and the upper disk
  for (Index f = 0; f < cylinder.mesh.face_count(); ++f) {
    if (std::abs(normals[f].z()) < 0.9 || std::abs(indices[f]) < 0.1) continue;
    EXPECT_NEAR(indices[f], 0.25, 1e-6);
    Vec3 middle = cylinder.mesh.origin;
    for (int i = 0; i < 3; ++i) {
      middle += cylinder.mesh.positions[cylinder.mesh.from(3 * f + i)] / 3;
    }
    const double radius = std::hypot(middle.x(), middle.y()) / kCylinderRadius;
    EXPECT_GT(radius, 0.7 * best);
    EXPECT_LT(radius, 1.1 * best);
    angles[normals[f].z() > 0 ? 1 : 0].push_back(std::atan2(middle.y(), middle.x()));
  }
  for (std::vector<double>& of_disk : angles) {
    ASSERT_EQ(of_disk.size(), 4);
    std::ranges::sort(of_disk);
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(of_disk[i + 1] - of_disk[i], M_PI / 2, 15 * kDegree);
    }
  }
}

/// Without any reliable direction the matrix is nearly singular: rounding must not make it
/// indefinite.
TEST(CrossField, IsSoundWhereNothingHoldsIt) {
  for (const SampleKind kind : {SampleKind::torus, SampleKind::sphere}) {
    const support::Prepared prepared = support::prepare(noisy_sample(kind, 1e-3));
    PrincipalField field = prepared.field;
    std::ranges::fill(field.wedge_confidence, 0.0);
    EXPECT_LT(extend_cross_field(prepared.mesh, wedge_graph(prepared.mesh), kStiffness, {}, field),
              SolverOptions{}.max_iterations);
    for (Index w = 0; w < prepared.mesh.wedge_count(); ++w) {
      ASSERT_NEAR(field.cross[w].norm(), 1, 1e-9);
      ASSERT_NEAR(field.cross[w].dot(field.normal[w]), 0, 1e-9);
    }
    EXPECT_NEAR(index_sum(prepared.mesh, field), kind == SampleKind::torus ? 0 : 2, 1e-6);
  }
}

/// Vertices are off the surface by 3 % of an edge. The mean error of the tensors' own directions is
/// the bound: extending them must not lose any of that where they are clear.
TEST(CrossField, IsNoWorseThanTheTensorsOnNoisySurfaces) {
  for (const SampleKind kind :
       {SampleKind::torus, SampleKind::ellipsoid, SampleKind::hyperboloid}) {
    SCOPED_TRACE(sample_names()[static_cast<std::size_t>(kind)]);
    const support::AnalyticSurface surface = support::analytic_surface(kind);
    const PolyMesh soup = noisy_sample(kind, 1e-3);
    const support::Prepared prepared = support::prepare(soup);
    SmoothOptions raw;
    raw.iterations = 0;
    raw.extension = "paper";
    const PrincipalField tensors = support::prepare(soup, {}, raw).field;
    double of_cross = 0;
    double of_tensors = 0;
    double count = 0;
    for (Index w = 0; w < prepared.mesh.wedge_count(); ++w) {
      const Vec3 p = prepared.mesh.positions[prepared.mesh.wedge_vertex[w]] + prepared.mesh.origin;
      const support::ExactCurvature exact = surface.at(p);
      if (exact.anisotropy() < 0.3) continue;
      of_cross += angle_to_cross(prepared.field, w, exact.t_min);
      of_tensors += angle_to_cross(tensors, w, exact.t_min);
      ++count;
    }
    ASSERT_GT(count, 1000);
    EXPECT_LT(of_cross, of_tensors);
    EXPECT_LT(of_cross / count, 2 * kDegree);
  }
}

}  // namespace
}  // namespace strake
