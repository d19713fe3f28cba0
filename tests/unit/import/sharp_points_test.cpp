#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/geometry/samples/samples.h"
#include "stages/import/features.h"
#include "tests/support/cones.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

std::ptrdiff_t corners(const TriMesh& mesh) { return std::ranges::count(mesh.is_corner, 1); }

/// Noise of a share of the mean edge's length along all directions.
PolyMesh noisy(PolyMesh mesh, double size) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal(0, size);
  for (Vec3& p : mesh.positions) p += Vec3(normal(random), normal(random), normal(random));
  return mesh;
}

TEST(SharpPoints, TipsOfConesAreCorners) {
  for (const double height : {0.6, 1.0, 4.0}) {
    for (const int rings : {1, 20}) {
      const TriMesh mesh = shapes::imported(support::cone(60, rings, height)).mesh;
      ASSERT_EQ(corners(mesh), 1) << height << ' ' << rings;
      const auto tip = std::ranges::find(mesh.is_corner, 1) - mesh.is_corner.begin();
      EXPECT_EQ(mesh.positions[tip] + mesh.origin, Vec3(0, 0, height));
    }
  }
}

// A quarter of a right angle is seen; a tenth is not.
TEST(SharpPoints, BluntTipsAreNone) {
  EXPECT_EQ(corners(shapes::imported(support::cone(60, 20, 0.2)).mesh), 0);
}

// Poles have many faces, but miss no more than the faces around them.
TEST(SharpPoints, CoarseRoundsHaveNone) {
  SampleOptions options;
  for (const std::int64_t faces : {500, 1000, 3000}) {
    options.faces = faces;
    EXPECT_EQ(corners(shapes::imported(make_sample(SampleKind::sphere, options)).mesh), 0);
    EXPECT_EQ(corners(shapes::imported(make_sample(SampleKind::ellipsoid, options)).mesh), 0);
  }
}

TEST(SharpPoints, NoiseHasNone) {
  SampleOptions options;
  options.faces = 5000;
  const PolyMesh sphere = make_sample(SampleKind::sphere, options);
  // Edges are about 0.05 long.
  const TriMesh mesh = shapes::imported(noisy(sphere, 0.01)).mesh;
  const auto features = std::ranges::count(mesh.is_feature, 1);
  EXPECT_LE(corners(mesh), features / 2 + mesh.vertex_count() / 500);
}

}  // namespace
}  // namespace strake
