// What must not matter to the curvature tensor: place, turn, size, names, orientation, threads.
//
// Tolerances. Dihedral angles are kept in single precision: relative 2^-24 = 6e-8 each, hence of
// the tensor too, up to the ratio of the sum of |beta| |e| to its signed sum, which is below 10 on
// these meshes. Everything else is double: 1e-16 / h. So 1e-6 of the largest curvature.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>

#include "tests/convergence/tensor_support.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

constexpr double kTolerance = 1e-6;

PolyMesh sample_soup(SampleKind kind, std::int64_t faces = 4000) {
  SampleOptions options;
  options.faces = faces;
  return make_sample(kind, options);
}

double largest(const TensorField& field) {
  double norm = 0;
  for (Index w = 0; w < static_cast<Index>(field.tensor.size()); ++w) {
    norm = std::max(norm, support::tensor_matrix(field, w).norm());
  }
  return norm;
}

class TensorInvariance : public ::testing::TestWithParam<SampleKind> {
 protected:
  TensorInvariance()
      : soup_(sample_soup(GetParam())),
        mesh_(support::plain_tri_mesh(soup_)),
        radius_{3 * support::mean_edge_length(mesh_), false},
        field_(support::tensors(mesh_, radius_)),
        scale_(largest(field_)) {}

  /// Compares with a mesh of the same vertices in the same order.
  void expect_mapped(const PolyMesh& moved, const Mat3& turn, double size, double sign) {
    const TriMesh mesh = support::plain_tri_mesh(moved);
    const TensorField field = support::tensors(mesh, {size * radius_.value, false});
    for (Index w = 0; w < mesh_.wedge_count(); ++w) {
      const Mat3 expected =
          sign / size * turn * support::tensor_matrix(field_, w) * turn.transpose();
      ASSERT_LT((support::tensor_matrix(field, w) - expected).norm(), kTolerance * scale_ / size)
          << "vertex " << w;
      ASSERT_LT((field.normal[w] - sign * turn * field_.normal[w]).norm(), 1e-12);
    }
  }

  PolyMesh soup_;
  TriMesh mesh_;
  Length radius_;
  TensorField field_;
  double scale_;
};

INSTANTIATE_TEST_SUITE_P(Surfaces, TensorInvariance,
                         ::testing::Values(SampleKind::torus, SampleKind::saddle,
                                           SampleKind::hyperboloid),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(TensorInvariance, TurnsWithTheModel) {
  const Mat3 turn = support::oblique_rotation();
  expect_mapped(support::transformed(soup_, turn), turn, 1, 1);
}

TEST_P(TensorInvariance, IsMirroredWithTheModel) {
  const Mat3 mirror = support::oblique_reflection();
  expect_mapped(support::transformed(soup_, mirror), mirror, 1, 1);
}

TEST_P(TensorInvariance, IsAnInverseLength) {
  for (const double size : {1e3, 1e-6}) {
    expect_mapped(support::transformed(soup_, size * Mat3::Identity()), Mat3::Identity(), size, 1);
  }
}

TEST_P(TensorInvariance, ChangesSignWithTheOrientation) {
  PolyMesh turned = soup_;
  for (Index f = 0; f < turned.face_count(); ++f) {
    std::reverse(turned.corners.begin() + turned.offsets[f],
                 turned.corners.begin() + turned.offsets[f + 1]);
  }
  expect_mapped(turned, Mat3::Identity(), 1, -1);
}

TEST_P(TensorInvariance, RadiusMayBeAShareOfTheDiagonal) {
  const TensorField share = support::tensors(mesh_, {radius_.value / mesh_.diagonal, true});
  for (Index w = 0; w < mesh_.wedge_count(); ++w) {
    ASSERT_LT((support::tensor_matrix(share, w) - support::tensor_matrix(field_, w)).norm(),
              kTolerance * scale_);
  }
}

TEST_P(TensorInvariance, DoesNotDependOnNames) {
  const support::PermutedMesh shuffled = support::permuted(soup_, 11);
  const TriMesh mesh = support::plain_tri_mesh(shuffled.mesh);
  const TensorField field = support::tensors(mesh, radius_);
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    ASSERT_LT(
        (support::tensor_matrix(field, w) - support::tensor_matrix(field_, shuffled.old_vertex[w]))
            .norm(),
        kTolerance * scale_);
  }
}

TEST_P(TensorInvariance, DoesNotDependOnThePlace) {
  const double distance = 1e6;
  const Vec3 shift(distance, -distance, 0.7 * distance);
  const TriMesh here = support::import_tri_mesh(soup_);
  const TriMesh there =
      support::import_tri_mesh(support::transformed(soup_, Mat3::Identity(), shift));
  const TensorField at_home = support::tensors(here, radius_);
  const TensorField away = support::tensors(there, radius_);
  ASSERT_EQ(here.wedge_count(), there.wedge_count());
  std::vector<Index> wedge_of_source(here.positions.size());
  for (Index w = 0; w < there.wedge_count(); ++w) {
    wedge_of_source[there.source_vertex[there.wedge_vertex[w]]] = w;
  }
  // The file itself is rounded to 1e6 2^-53 = 1.1e-10 = d. That turns an edge of length h by
  // 4 d / h or so; a ball has 3 pi r^2 / (0.87 h^2) edges of length h over an area of pi r^2.
  double shortest = radius_.value;
  for (Index h = 0; h < here.halfedge_count(); ++h) {
    shortest =
        std::min(shortest, (here.positions[here.to(h)] - here.positions[here.from(h)]).norm());
  }
  const double rounding = distance * 0x1p-53;
  const double tolerance = 4 * rounding * 3 / (0.87 * shortest * shortest) + kTolerance * scale_;
  for (Index w = 0; w < here.wedge_count(); ++w) {
    const Index other = wedge_of_source[here.source_vertex[here.wedge_vertex[w]]];
    ASSERT_LT((support::tensor_matrix(at_home, w) - support::tensor_matrix(away, other)).norm(),
              tolerance);
  }
}

TEST_P(TensorInvariance, IsTheSameForAnyNumberOfThreads) {
  for (const std::size_t threads : {1U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    const TensorField field = support::tensors(mesh_, radius_);
    EXPECT_EQ(field.tensor, field_.tensor);
    EXPECT_TRUE(field.normal == field_.normal);
  }
}

TEST(TensorOfAPlane, Vanishes) {
  const TriMesh mesh = support::plain_tri_mesh(sample_soup(SampleKind::plane));
  const TensorField field = support::tensors(mesh, percent(5));
  EXPECT_EQ(largest(field), 0);
  for (const Vec3& normal : field.normal) EXPECT_LT((normal - Vec3::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace strake
