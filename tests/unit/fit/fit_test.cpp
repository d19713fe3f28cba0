#include "stages/fit/fit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <map>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A sphere of radius 1 as a subdivided icosahedron. The vertices of a level come first in all
/// finer ones.
PolyMesh icosphere(int level) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> positions = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                 {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                 {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& p : positions) p.normalize();
  std::vector<std::array<Index, 3>> faces = {
      {0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
      {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
      {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<Index, Index>, Index> middle;
    const auto between = [&](Index a, Index b) {
      const auto [at, is_new] = middle.try_emplace(std::minmax(a, b), Index(positions.size()));
      if (is_new) positions.push_back((positions[a] + positions[b]).normalized());
      return at->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const Index ab = between(a, b);
      const Index bc = between(b, c);
      const Index ca = between(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  PolyMesh mesh;
  mesh.positions = positions;
  for (const auto& face : faces) mesh.add_face(face);
  return mesh;
}

/// A coarse icosphere as a result on a fine one.
struct SphereCase {
  TriMesh mesh = support::plain_tri_mesh(icosphere(6));
  QuadMesh quads;

  SphereCase() {
    quads.mesh = icosphere(2);
    for (Index v = 0; v < quads.mesh.vertex_count(); ++v) {
      const Index h = mesh.vertex_out[v];
      std::array<double, 3> barycentric = {0, 0, 0};
      barycentric[h % 3] = 1;
      quads.provenance.face.push_back(TriMesh::face_of(h));
      quads.provenance.barycentric.push_back(barycentric);
      quads.provenance.lines.push_back({kNone, kNone});
    }
  }
};

QuadMesh fitted(const TriMesh& mesh, const QuadMesh& quads, std::int64_t rounds = 3) {
  SilentObserver observer;
  FitOptions options;
  options.rounds = rounds;
  return fit_vertices(mesh, quads, options, observer).quads;
}

double ratio(const TriMesh& mesh, const QuadMesh& quads) {
  SilentObserver observer;
  const FitResult result = fit_vertices(mesh, quads, {}, observer);
  for (const auto& [key, value] : result.report.entries()) {
    if (key == "fit.rms_ratio") return std::get<double>(value);
  }
  return NAN;
}

// Over an equilateral triangle between points of a sphere the distance is, to leading order,
// proportional to q = ab + bc + ca in barycentric coordinates: mean 1/4, mean square 1/15. A common
// shift removes the mean, so the root mean square falls to sqrt((1/15 - 1/16) / (1/15)) = 1/4. The
// edges of the icosphere differ by 18 %, so q differs by 40 % between triangles, most of which
// single vertices cannot follow: 0.35 leaves room for it.
TEST(Fit, ShiftsAnInscribedSphereByItsMeanDistance) {
  const SphereCase sphere;
  EXPECT_LT(ratio(sphere.mesh, sphere.quads), 0.35);
  EXPECT_GT(ratio(sphere.mesh, sphere.quads), 0.24);
  const QuadMesh result = fitted(sphere.mesh, sphere.quads);
  for (const Vec3& p : result.mesh.positions) {
    EXPECT_GT(p.norm(), 1);
    EXPECT_LT(p.norm(), 1.05);
  }
}

TEST(Fit, WorksAtAnyPlaceAndScale) {
  const SphereCase sphere;
  const QuadMesh plain = fitted(sphere.mesh, sphere.quads);
  SphereCase moved;
  const double scale = 1e-3;
  const Vec3 origin(1e4, -2e4, 3e4);
  for (Vec3& p : moved.mesh.positions) p *= scale;
  moved.mesh.diagonal *= scale;
  moved.mesh.origin = origin;
  for (Vec3& p : moved.quads.mesh.positions) p = scale * p + origin;
  const QuadMesh result = fitted(moved.mesh, moved.quads);
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    const Vec3 back = (result.mesh.positions[v] - origin) / scale;
    // Positions far away are rounded to 3e4 * 2^-53, here 4e-9 of the radius; one solver
    // tolerance of 1e-6 of the shifts, of about 0.02, comes on top.
    EXPECT_LT((back - plain.mesh.positions[v]).norm(), 1e-7);
  }
}

TEST(Fit, NoRoundsChangeNothing) {
  const SphereCase sphere;
  EXPECT_EQ(fitted(sphere.mesh, sphere.quads, 0).mesh.positions, sphere.quads.mesh.positions);
}

TEST(Fit, GivesTheSameBitsForAnyThreadCount) {
  const SphereCase sphere;
  std::vector<std::vector<Vec3>> results;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(fitted(sphere.mesh, sphere.quads).mesh.positions);
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

class FitOfSamples : public testing::TestWithParam<SampleKind> {
 protected:
  FitOfSamples() {
    SampleOptions options;
    options.faces = 12000;
    surface_ = support::prepare(make_sample(GetParam(), options));
    quads_ = support::mesh(surface_, support::trace(surface_));
  }

  support::Prepared surface_;
  QuadMesh quads_;
};

TEST_P(FitOfSamples, LeavesFeaturesAndBoundariesWhereTheyAre) {
  const TriMesh& mesh = surface_.mesh;
  const QuadMesh result = fitted(mesh, quads_);
  int held = 0;
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    const Index face = quads_.provenance.face[v];
    const auto& at = quads_.provenance.barycentric[v];
    for (int i = 0; i < 3; ++i) {
      if (at[i] != 0 || !mesh.is_barrier(3 * face + (i + 1) % 3)) continue;
      EXPECT_EQ(result.mesh.positions[v], quads_.mesh.positions[v]) << v;
      ++held;
    }
  }
  const bool has_lines = GetParam() != SampleKind::torus && GetParam() != SampleKind::sphere;
  EXPECT_EQ(held > 0, has_lines);
}

TEST_P(FitOfSamples, NeverIncreasesTheDistanceNorMakesFacesConcave) {
  EXPECT_LE(ratio(surface_.mesh, quads_), 1);
  const QuadMesh result = fitted(surface_.mesh, quads_);
  EXPECT_EQ(result.mesh.corners, quads_.mesh.corners);
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    if (is_concave_face(quads_.mesh.positions, quads_.mesh.face(f))) continue;
    EXPECT_FALSE(is_concave_face(result.mesh.positions, result.mesh.face(f))) << f;
  }
}

INSTANTIATE_TEST_SUITE_P(Samples, FitOfSamples,
                         testing::Values(SampleKind::plane, SampleKind::torus, SampleKind::cylinder,
                                         SampleKind::part));

}  // namespace
}  // namespace strake
