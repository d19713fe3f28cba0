// Convergence of the normal-cycle tensor (stages/tensor) to the exact curvature.
//
// Why it converges, and how fast, with mean edge length h and ball radius r, h << r << 1/|k|:
//  - The sum over a ball B differs from the integral over the smooth surface by at most
//    C h (r^2 + r): interior and rim (Cohen-Steiner and Morvan 2003, theorem 3, for triangles of
//    bounded shape with vertices on the surface). Divided by |B| ~ r^2: C h / r at worst. On
//    irregular meshes the r / h contributions of the rim are of either sign, so that (h / r)^(3/2)
//    is typical.
//  - The mean over B differs from the value in its middle by C r^2: odd terms cancel in a round
//  ball.
// With r = c h^(1/2) the guaranteed order is 1/2, the typical one 3/4, and the bias of the
// mean is of order 1. Directions follow the tensor where the principal curvatures differ.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/convergence/tensor_support.h"
#include "tests/support/import_support.h"
#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

using support::ExactCurvature;

/// Errors over the vertices of one mesh: root mean squares unless it says otherwise.
struct Errors {
  double tensor = 0, largest_tensor = 0;
  double mean_curvature_bias = 0;        ///< |mean of the signed errors of k_min + k_max|
  double curvatures = 0, direction = 0;  ///< where the families are clearly different
  double normal = 0;
  double clear_share = 0;  ///< of the vertices that count for `curvatures`
};

std::vector<std::uint8_t> beside_boundary(const TriMesh& mesh, double distance) {
  std::vector<Vec3> rim;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) rim.push_back(mesh.positions[mesh.from(h)]);
  }
  std::vector<std::uint8_t> beside(mesh.positions.size(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    beside[v] = std::any_of(rim.begin(), rim.end(), [&](const Vec3& q) {
      return (q - mesh.positions[v]).squaredNorm() < distance * distance;
    });
  }
  return beside;
}

/// Compares wedges, leaving out those whose vertex is marked.
Errors measure(const TriMesh& mesh, const TensorField& field,
               const support::AnalyticSurface& surface, const std::vector<std::uint8_t>& left_out) {
  Errors sum;
  double signed_sum = 0;
  Index count = 0, clear = 0;
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const Index v = mesh.wedge_vertex[w];
    if (left_out[v] != 0) continue;
    ++count;
    const ExactCurvature exact = surface.at(mesh.positions[v]);
    const Mat3 tensor = support::tensor_matrix(field, w);
    const double error = (tensor - support::exact_tensor(exact)).norm();
    sum.tensor += error * error;
    sum.largest_tensor = std::max(sum.largest_tensor, error);
    signed_sum += tensor.trace() - exact.k_min - exact.k_max;
    sum.normal += (field.normal[w] - exact.normal).squaredNorm();
    if (exact.anisotropy() < 0.2) continue;
    ++clear;
    const support::Principal found = support::principal(tensor, field.normal[w]);
    sum.curvatures +=
        std::pow(found.k_min - exact.k_min, 2) + std::pow(found.k_max - exact.k_max, 2);
    sum.direction += std::pow(support::line_angle(found.t_min, exact.t_min), 2);
  }
  const auto root_mean = [](double total, Index n) { return n > 0 ? std::sqrt(total / n) : 0.0; };
  return {root_mean(sum.tensor, count),
          sum.largest_tensor,
          std::abs(signed_sum / count),
          root_mean(sum.curvatures, clear),
          root_mean(sum.direction, clear),
          root_mean(sum.normal, count),
          double(clear) / count};
}

/// Radius of the balls for mean edge length h; 2.5 edges at the coarsest mesh.
double shrinking_radius(double h, double coarsest) { return 2.5 * std::sqrt(coarsest * h); }

TriMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return support::plain_tri_mesh(make_sample(kind, options));
}

/// Two octaves of edge lengths.
constexpr std::int64_t kFaces[] = {3000, 12000, 48000};

/// The slope of one kind of error over the sizes.
double order(const std::vector<double>& sizes, const std::vector<Errors>& errors,
             double Errors::*which) {
  std::vector<double> values;
  for (const Errors& e : errors) values.push_back(e.*which);
  return support::observed_order(sizes, values);
}

class TensorConvergence : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Surfaces, TensorConvergence,
                         ::testing::Values(SampleKind::sphere, SampleKind::open_cylinder,
                                           SampleKind::torus, SampleKind::ellipsoid,
                                           SampleKind::hyperboloid, SampleKind::saddle),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(TensorConvergence, AwayFromBoundaries) {
  const auto surface = support::analytic_surface(GetParam());
  std::vector<double> sizes;
  std::vector<Errors> errors;
  double sharpest = 0;
  for (const std::int64_t faces : kFaces) {
    const TriMesh mesh = sample(GetParam(), faces);
    for (const Vec3& p : mesh.positions) {
      sharpest = std::max(sharpest, std::abs(surface.at(p).k_max));
    }
    sizes.push_back(support::mean_edge_length(mesh));
    const double radius = shrinking_radius(sizes.back(), sizes.front());
    errors.push_back(measure(mesh, support::tensors(mesh, {radius, false}), surface,
                             beside_boundary(mesh, 1.1 * radius)));
  }
  EXPECT_GT(order(sizes, errors, &Errors::tensor), 0.5);
  // A maximum is over 16 times more vertices at the end: its bound has the same order, with
  // scatter.
  EXPECT_GT(order(sizes, errors, &Errors::largest_tensor), 0.4);
  // Normals of triangles are off by h k / 2 or so, in a direction that the mean over a vertex
  // reduces but not removes: first order. Fitted over two octaves of h, hence the 0.1.
  EXPECT_GT(order(sizes, errors, &Errors::normal), 0.9);
  // In the mean over all vertices the random parts cancel. What would stay is a systematic error,
  // as from a lost share of the area or of the edges.
  EXPECT_LT(errors.back().mean_curvature_bias, 0.005 * sharpest);
  if (GetParam() == SampleKind::sphere) return;  // it has no directions
  EXPECT_GT(errors.back().clear_share, 0.1);
  EXPECT_GT(order(sizes, errors, &Errors::curvatures), 0.5);
  EXPECT_GT(order(sizes, errors, &Errors::direction), 0.5);
}

/// Only vertices on boundaries or features: their balls are cut in half.
std::vector<std::uint8_t> off_the_rim(const TriMesh& mesh) {
  std::vector<std::uint8_t> off(mesh.positions.size(), 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_barrier(h)) off[mesh.from(h)] = off[mesh.to(h)] = 0;
  }
  return off;
}

// The area and the edges inside count up to the rim, and a cylinder is bent alike everywhere: half
// a ball tells the same. The edges along the cut are missing, of h r in r^2: order 1/2, less 0.1
// for the scatter of a fit over two octaves.
TEST(TensorAtTheRim, ConvergesOnTheBoundaryOfAnOpenCylinder) {
  const auto surface = support::analytic_surface(SampleKind::open_cylinder);
  std::vector<double> sizes;
  std::vector<Errors> errors;
  for (const std::int64_t faces : kFaces) {
    const TriMesh mesh = sample(SampleKind::open_cylinder, faces);
    sizes.push_back(support::mean_edge_length(mesh));
    const double radius = shrinking_radius(sizes.back(), sizes.front());
    errors.push_back(
        measure(mesh, support::tensors(mesh, {radius, false}), surface, off_the_rim(mesh)));
  }
  EXPECT_GT(order(sizes, errors, &Errors::tensor), 0.4);
  EXPECT_GT(order(sizes, errors, &Errors::direction), 0.4);
}

TEST(TensorAtTheRim, IsNotDisturbedByTheOtherSideOfASharpEdge) {
  const auto surface = support::analytic_surface(SampleKind::cylinder);
  std::vector<double> sizes;
  std::vector<Errors> errors;
  for (const std::int64_t faces : kFaces) {
    SampleOptions options;
    options.faces = faces;
    const TriMesh mesh = support::import_tri_mesh(make_sample(SampleKind::cylinder, options));
    ASSERT_GT(mesh.wedge_count(), mesh.vertex_count()) << "the rims are no features";
    sizes.push_back(support::mean_edge_length(mesh));
    const double radius = shrinking_radius(sizes.back(), sizes.front());
    TensorField field = support::tensors(mesh, {radius, false});
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
      if (std::abs(field.normal[w].z()) < 0.5) continue;
      // On a cap: flat up to the rounding of positions, 1e-16 / h at each edge.
      EXPECT_LT(support::tensor_matrix(field, w).norm(), 1e-12);
      // From here on only the side is measured.
      const auto exact = surface.at(mesh.positions[mesh.wedge_vertex[w]]);
      const Mat3 m = support::exact_tensor(exact);
      field.tensor[w] = {m(0, 0), m(0, 1), m(0, 2), m(1, 1), m(1, 2), m(2, 2)};
    }
    errors.push_back(measure(mesh, field, surface, off_the_rim(mesh)));
  }
  EXPECT_GT(order(sizes, errors, &Errors::tensor), 0.4);
}

}  // namespace
}  // namespace strake
