#include "stages/import/features.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::imported;

constexpr double kDegree = std::numbers::pi / 180;

/// A unit square folded along x = 1/2 by `angle_deg`, where `fade(y)` scales the fold's slope.
template <typename Fade>
PolyMesh fold(double angle_deg, int n, const Fade& fade) {
  const double slope = std::tan(0.5 * angle_deg * kDegree);
  return shapes::grid(
      n, n, [&](double x, double y) { return slope * fade(y) * (0.5 - std::abs(x - 0.5)); });
}

double unfaded(double) { return 1; }

Index corners(const TriMesh& mesh) {
  return static_cast<Index>(std::count(mesh.is_corner.begin(), mesh.is_corner.end(), 1));
}

Index feature_edges(const TriMesh& mesh) {
  return static_cast<Index>(std::count(mesh.is_feature.begin(), mesh.is_feature.end(), 1)) / 2;
}

/// A cube whose faces are grids of n x n quads.
PolyMesh fine_cube(int n) {
  PolyMesh all;
  for (int side = 0; side < 6; ++side) {
    PolyMesh sheet = shapes::grid(n, n, [](double, double) { return 0.0; });
    for (Vec3& p : sheet.positions) {
      const Vec3 q(p.x(), p.y(), side < 3 ? 0 : 1);
      p = side % 3 == 0 ? q
                        : (side % 3 == 1 ? Vec3(q.z(), q.x(), q.y()) : Vec3(q.y(), q.z(), q.x()));
    }
    all = support::together(all, shapes::turned(sheet, [&](Index) { return side < 3; }));
  }
  return shapes::merged(all);
}

TEST(Features, EdgesOfACubeAndItsCorners) {
  for (const int n : {1, 2, 10}) {
    const TriMesh mesh = imported(fine_cube(n)).mesh;
    EXPECT_EQ(feature_edges(mesh), 12 * n);
    EXPECT_EQ(corners(mesh), 8);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      EXPECT_EQ(mesh.is_feature[h] != 0, support::dihedral_angle(mesh, h) > 0.5) << h;
    }
  }
}

TEST(Features, TheAngleDecidesOnSmoothFaces) {
  for (const double angle : {39.0, 41.0}) {
    const TriMesh mesh = imported(fold(angle, 20, unfaded)).mesh;
    EXPECT_EQ(feature_edges(mesh), angle > 40 ? 20 : 0);
  }
  EXPECT_EQ(feature_edges(imported(fold(170, 20, unfaded), {.feature_angle_deg = 180}).mesh), 0);
  EXPECT_EQ(feature_edges(imported(fold(12, 20, unfaded), {.feature_angle_deg = 10}).mesh), 20);
}

/// In the section of a fold the corners opposite its edges are one grid step away on either side.
TEST(Features, RidgesStandOutByMoreThanTheHeightAtAnyAngle) {
  constexpr int kSteps = 20;
  for (const double angle : {3.0, 12.0, 30.0}) {
    const double height = std::tan(0.5 * angle * kDegree) / kSteps;
    for (const double factor : {0.99, 1.01}) {
      ImportOptions options = shapes::undivided();
      options.feature_height = Length{factor * height, false};
      const TriMesh mesh = imported(fold(angle, kSteps, unfaded), options).mesh;
      EXPECT_EQ(feature_edges(mesh), factor < 1 ? kSteps : 0) << angle << " degrees";
    }
  }
}

/// Coarser meshes of the same fold stand out more.
TEST(Features, RidgesDependOnTheSizeOfFaces) {
  ImportOptions options = shapes::undivided();
  options.feature_height = percent(1);
  EXPECT_EQ(feature_edges(imported(fold(12, 4, unfaded), options).mesh), 4);
  EXPECT_EQ(feature_edges(imported(fold(12, 20, unfaded), options).mesh), 0);
}

TEST(Features, CreaseMeetsTheBoundaryInCorners) {
  const TriMesh mesh = imported(fold(80, 20, unfaded)).mesh;
  // Four of the square and two where the crease ends.
  EXPECT_EQ(corners(mesh), 6);
}

TEST(Features, GapInACreaseIsBridged) {
  // Bent by 50 degrees, but by 30 in the middle: more than 0.6 * 40.
  const double least = std::tan(15 * kDegree) / std::tan(25 * kDegree);
  const TriMesh mesh = imported(fold(50, 40, [&](double y) {
                         const double dip = std::cos(std::numbers::pi * (y - 0.5));
                         return 1 - (1 - least) * dip * dip;
                       })).mesh;
  EXPECT_EQ(feature_edges(mesh), 40);
  // Where it fades out for good it ends: 2 atan(tan(25) (1 - y)) falls below 40 degrees at 0.22.
  const TriMesh fading = imported(fold(50, 40, [](double y) { return 1 - y; })).mesh;
  EXPECT_NEAR(feature_edges(fading), 0.22 * 40, 1);
}

TEST(Features, TinyPiecesAreNoise) {
  // A roof of three vertices on a fine grid: bent by 50 degrees along its ridge, by 25 at its foot.
  const int n = 400;
  PolyMesh mesh = shapes::grid(n, n, [](double, double) { return 0.0; });
  for (const int j : {199, 200, 201}) {
    mesh.positions[j * (n + 1) + 200].z() = std::tan(25 * kDegree) / n;
  }
  const ImportResult result = imported(mesh);
  EXPECT_GT(shapes::count(result.report, "features.strong_edges"), 0);
  EXPECT_EQ(feature_edges(result.mesh), 0);
}

TEST(Features, NoiseIsNoCrease) {
  PolyMesh mesh = shapes::grid(80, 80, [](double, double) { return 0.0; });
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.2 / 80);
  for (Vec3& p : mesh.positions) p.z() += noise(random);
  const ImportResult result = imported(mesh);
  // Height differences of 0.2 sqrt 2 edges bend many edges by more than 40 degrees.
  EXPECT_LT(feature_edges(result.mesh), 80 * 80 * 3 / 100);
}

TEST(Features, SliversDoNotTurnTheirNeighboursIntoCreases) {
  // A flat square with a triangle of no height on the diagonal, its apex off by rounding.
  for (const double offset : {-1e-9, 0.0, 1e-9}) {
    const TriMesh mesh = imported(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                                    Vec3(0, 1, 0), Vec3(0.5 + offset, 0.5, offset)},
                                                   {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}, {3, 0, 4}}))
                             .mesh;
    EXPECT_EQ(feature_edges(mesh), 0) << offset;
  }
}

TEST(Corners, OfASquareAndNoneOfADisk) {
  const PolyMesh square = shapes::grid(30, 30, [](double, double) { return 0.0; });
  EXPECT_EQ(corners(imported(square).mesh), 4);
  PolyMesh disk = square;
  for (Vec3& p : disk.positions) {
    // Square rings become circles.
    const Vec3 q = 2 * p - Vec3(1, 1, 0);
    const double radius = std::max(std::abs(q.x()), std::abs(q.y()));
    p = q.norm() > 0 ? Vec3(radius * q.normalized()) : Vec3(Vec3::Zero());
  }
  EXPECT_EQ(corners(imported(disk).mesh), 0);
}

TEST(Corners, RaggedBoundariesHaveFew) {
  PolyMesh mesh = shapes::grid(100, 100, [](double, double) { return 0.0; });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.004, 0.004);
  for (Vec3& p : mesh.positions) p += Vec3(shift(random), shift(random), 0);
  const TriMesh result = imported(mesh).mesh;
  Index boundary_vertices = 0;
  for (Index v = 0; v < result.vertex_count(); ++v) {
    boundary_vertices += result.is_boundary(result.vertex_out[v]) ? 1 : 0;
  }
  EXPECT_GE(corners(result), 4);
  EXPECT_LE(corners(result), 8);
  EXPECT_EQ(boundary_vertices, 400);
}

TEST(Corners, AreWhereOtherThanTwoLinesMeet) {
  const TriMesh mesh = imported(fine_cube(6)).mesh;
  std::vector<Index> degree(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) degree[mesh.from(h)] += mesh.is_feature[h];
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (degree[v] == 2) continue;
    EXPECT_EQ(mesh.is_corner[v] != 0, degree[v] != 0);
  }
}

}  // namespace
}  // namespace strake
