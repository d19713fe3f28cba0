#include "stages/tensor/wedge_tensors.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "stages/tensor/tensor.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A flat face and one that is folded onto it over the edge from vertex 1 to 2; the vertex 0 is in
/// the first face only.
TriMesh folded_pair() {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3, 0.3, 0.02}};
  mesh.add_face(std::array<Index, 3>{0, 1, 2});
  mesh.add_face(std::array<Index, 3>{1, 3, 2});
  return support::plain_tri_mesh(mesh);
}

// A ball goes no farther than to where the surface folds over, and the fold bends nothing in it,
// whether the ball holds the face whole, cuts a small one, or a large one.
TEST(WedgeTensors, DoNotSeeWhatFoldsOver) {
  const TriMesh mesh = folded_pair();
  const Index wedge = mesh.wedge_of(0);
  for (const double radius : {0.3, 0.6, 0.9, 1.2, 5.0}) {
    SilentObserver observer;
    const WedgeTensors tensors = estimate_wedge_tensors(mesh, {wedge}, {radius}, observer);
    for (const auto entry : tensors.tensor.front()) EXPECT_NEAR(entry, 0, 1e-6) << radius;
  }
}

TEST(EstimateTensors, OfACoarserMeshAreThoseOfTheMeshThere) {
  SampleOptions options;
  options.faces = 9000;
  const TriMesh mesh = support::plain_tri_mesh(make_sample(SampleKind::torus, options));
  TriMesh coarse;
  coarse.id = "coarse";
  for (Index w = 5; w < mesh.wedge_count(); w += 7) coarse.parent_wedge.push_back(w);
  SilentObserver observer;
  const TensorField all = estimate_tensors(mesh, {}, observer).field;
  const TensorField some = estimate_tensors(mesh, {}, observer, &coarse).field;
  EXPECT_EQ(some.mesh_id, coarse.id);
  ASSERT_EQ(some.tensor.size(), coarse.parent_wedge.size());
  for (std::size_t i = 0; i < some.tensor.size(); ++i) {
    EXPECT_EQ(some.tensor[i], all.tensor[coarse.parent_wedge[i]]);
    EXPECT_EQ(some.normal[i], all.normal[coarse.parent_wedge[i]]);
  }
}

// Areas of the largest of these are no numbers in single precision, and of the smallest they are 0.
TEST(WedgeTensors, AreTheSameInAnyUnit) {
  SampleOptions options;
  options.faces = 3000;
  const TriMesh mesh = support::plain_tri_mesh(make_sample(SampleKind::torus, options));
  std::vector<Index> wedges(static_cast<std::size_t>(mesh.wedge_count()));
  std::iota(wedges.begin(), wedges.end(), Index{0});
  SilentObserver observer;
  const double radius = 0.2;
  const WedgeTensors usual = estimate_wedge_tensors(mesh, wedges, {radius}, observer);
  for (const int exponent : {-95, -30, 30, 65, 190}) {
    TriMesh scaled = mesh;
    for (Vec3& p : scaled.positions) p *= std::exp2(exponent);
    const WedgeTensors tensors =
        estimate_wedge_tensors(scaled, wedges, {std::ldexp(radius, exponent)}, observer);
    EXPECT_EQ(tensors.normal, usual.normal) << exponent;
    for (std::size_t i = 0; i < wedges.size(); ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_EQ(tensors.tensor[i][k], std::ldexp(usual.tensor[i][k], -exponent)) << exponent;
      }
    }
  }
}

// A ball of 1 % of the diagonal would hold half of the sphere, up to where it folds over; one that
// shrinks holds less than a tenth, where a normal is (0, 0, 1) but for 0.1 in the mean square.
TEST(WedgeTensors, SeeCurvatureBesideAVertexFarAway) {
  SampleOptions options;
  options.faces = 40000;
  PolyMesh sphere = make_sample(SampleKind::sphere, options);
  const Index last = sphere.vertex_count() - 1;
  sphere.positions[last] *= 1000;
  const TriMesh mesh = support::plain_tri_mesh(sphere);
  const Index count = 1000;
  std::vector<Index> wedges(count);
  std::iota(wedges.begin(), wedges.end(), Index{0});
  SilentObserver observer;
  const WedgeTensors tensors = estimate_wedge_tensors(
      mesh, wedges, ball_rule({}, mesh.diagonal, mesh.face_count()), observer);
  EXPECT_EQ(tensors.shrunk, count);
  for (Index w = 0; w < count; ++w) {
    const Vec3 p = mesh.positions[mesh.wedge_vertex[w]];
    const auto& [xx, xy, xz, yy, yz, zz] = tensors.tensor[w];
    const Mat3 tensor{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
    EXPECT_NEAR(tensor.trace(), 2, 0.05) << "wedge " << w;
    EXPECT_LT((tensor - (Mat3::Identity() - p * p.transpose())).norm(), 0.2) << "wedge " << w;
  }
}

TEST(BallRule, IsAsAskedFor) {
  TensorOptions options;
  options.radius = percent(3);
  const BallRule rule = ball_rule(options, 2, 100'000'000);
  EXPECT_DOUBLE_EQ(rule.radius, 0.06);
  EXPECT_EQ(rule.most_faces, kNone);
}

// Faces in a ball: their number over the area of the surface, times that of the ball.
TEST(BallRule, KeepsTheNumberOfFacesInABallBounded) {
  const auto faces_in_a_ball = [](Index faces) {
    const double radius = ball_rule({}, 1, faces).radius;
    return faces * radius * radius;
  };
  EXPECT_DOUBLE_EQ(ball_rule({}, 2, 12).radius, 0.02);
  EXPECT_DOUBLE_EQ(ball_rule({}, 2, 1'000'000).radius, 0.02);
  for (const Index faces : {4'000'000, 16'000'000, 370'000'000}) {
    EXPECT_NEAR(faces_in_a_ball(faces), faces_in_a_ball(2'000'000), 1e-6) << faces;
  }
}

}  // namespace
}  // namespace strake
