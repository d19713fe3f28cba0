#include "stages/import/feature_noise.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "common/geometry/topology/vertex_ring.h"
#include "stages/import/feature_graph.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

constexpr double kRough = 10 * std::numbers::pi / 180;

/// A flat grid of n x n unit cells.
TriMesh flat_grid(int n = 24) {
  PolyMesh mesh = shapes::grid(n, n, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) p *= n;
  return shapes::imported(mesh).mesh;
}

Index vertex_at(const TriMesh& mesh, const Vec3& p) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if ((mesh.positions[v] - p).norm() < 1e-9) return v;
  }
  ADD_FAILURE() << "no vertex at " << p.transpose();
  return 0;
}

/// Flags the edges between consecutive points.
void draw(TriMesh& mesh, const std::vector<Vec3>& points) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    const Index to = vertex_at(mesh, points[i + 1]);
    bool found = false;
    for_each_outgoing(mesh, vertex_at(mesh, points[i]), [&](Index h) {
      if (mesh.to(h) != to) return;
      import::set_feature(mesh, h, true);
      found = true;
    });
    EXPECT_TRUE(found) << "no edge to " << points[i + 1].transpose();
  }
}  // namespace

/// Edges that are left of those drawn, where the ground is as rough everywhere.
Index left_on(double roughness, TriMesh mesh, const std::vector<Vec3>& points) {
  draw(mesh, points);
  import::drop_noise(mesh, std::vector<float>(mesh.halfedge_count(), float(roughness)));
  return static_cast<Index>(std::count(mesh.is_feature.begin(), mesh.is_feature.end(), 1)) / 2;
}

std::vector<Vec3> straight(int edges) {
  std::vector<Vec3> points;
  for (int i = 0; i <= edges; ++i) points.emplace_back(4 + i, 12, 0);
  return points;
}

/// One cell to the right and one up in turn: it turns by 90 degrees to and fro.
std::vector<Vec3> stairs(int edges) {
  std::vector<Vec3> points;
  for (int i = 0; i <= edges; ++i) points.emplace_back(4 + (i + 1) / 2, 4 + i / 2, 0);
  return points;
}

TEST(FeatureNoise, JaggedLinesAreNoiseOnRoughGroundOnly) {
  const TriMesh mesh = flat_grid();
  EXPECT_EQ(left_on(kRough, mesh, straight(12)), 12);
  EXPECT_EQ(left_on(kRough, mesh, stairs(12)), 0);
  EXPECT_EQ(left_on(0, mesh, stairs(12)), 12);
}

TEST(FeatureNoise, OneCornerMakesNoLineJagged) {
  // Twelve edges and a right angle: the turn changes by 90 degrees twice, 0 else; half the mean
  // over the ten edges between two turns is 9 degrees.
  std::vector<Vec3> points = straight(6);
  for (int i = 1; i <= 6; ++i) points.emplace_back(10, 12 + i, 0);
  EXPECT_EQ(left_on(kRough, flat_grid(), points), 12);
}

TEST(FeatureNoise, LooseLinesOnRoughGroundNeedEightEdges) {
  const TriMesh mesh = flat_grid();
  EXPECT_EQ(left_on(kRough, mesh, straight(8)), 8);
  EXPECT_EQ(left_on(kRough, mesh, straight(7)), 0);
  EXPECT_EQ(left_on(0, mesh, straight(7)), 7);
  // From boundary to boundary or between nodes a line is held, however few its edges.
  EXPECT_EQ(left_on(kRough, mesh, {Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(1, 0, 0)}), 2);
}

TEST(FeatureNoise, WhatGoesWithNoiseIsJudgedAgain) {
  // A straight line of five edges is held where a jagged one crosses its ends, and loose without.
  TriMesh mesh = flat_grid();
  draw(mesh, {Vec3(12, 14, 0), Vec3(12, 13, 0), Vec3(13, 13, 0), Vec3(13, 12, 0), Vec3(12, 12, 0)});
  std::vector<Vec3> line;
  for (int i = 0; i <= 5; ++i) line.emplace_back(12 - i, 12, 0);
  EXPECT_EQ(left_on(kRough, mesh, line), 0);
}

TEST(FeatureNoise, ClosedLinesTurnEvenlyWhateverTheirSides) {
  // Rings of a disk: eight sides turn by 45 degrees at every vertex, so the turn never changes.
  const auto ring = [](int sides) {
    std::vector<Vec3> positions = {Vec3::Zero()};
    std::vector<std::vector<Index>> faces;
    for (int r = 1; r <= 3; ++r) {
      for (int i = 0; i < sides; ++i) {
        const double angle = 2 * std::numbers::pi * i / sides;
        positions.emplace_back(r * std::cos(angle), r * std::sin(angle), 0);
        const Index a = (r - 1) * sides + i + 1;
        const Index b = (r - 1) * sides + (i + 1) % sides + 1;
        if (r == 1) faces.push_back({0, a, b});
        if (r > 1) faces.push_back({a - sides, a, b, b - sides});
      }
    }
    std::vector<Vec3> middle(positions.begin() + sides + 1, positions.begin() + 2 * sides + 1);
    middle.push_back(middle.front());
    return std::pair(shapes::imported(shapes::polygons(positions, faces)).mesh, middle);
  };
  const auto [octagon, eight] = ring(8);
  EXPECT_EQ(left_on(kRough, octagon, eight), 8);
  const auto [pentagon, five] = ring(5);
  EXPECT_EQ(left_on(kRough, pentagon, five), 0);
  EXPECT_EQ(left_on(0, pentagon, five), 5);
}

TEST(FeatureNoise, WhatRunsAroundOneFaceIsASpeck) {
  const TriMesh mesh = flat_grid();
  std::vector<Vec3> face;
  for (const Index v : mesh.faces[mesh.face_count() / 2]) face.push_back(mesh.positions[v]);
  face.push_back(face.front());
  EXPECT_EQ(left_on(0, mesh, face), 0);
}

/// Feature edges of a square of 24 x 24 cells with a spike in its middle, on ground that is moved
/// up and down at random by this share of a cell.
Index edges_of_spike(double noise) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> height(-noise, noise);
  PolyMesh mesh = shapes::grid(24, 24, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) {
    const bool is_spike = (p - Vec3(0.5, 0.5, 0)).norm() < 1e-9;
    p.z() = (is_spike ? 1.0 : height(random)) / 24;
  }
  const TriMesh imported = shapes::imported(mesh).mesh;
  Index edges = 0;
  for (Index h = 0; h < imported.halfedge_count(); ++h) {
    edges += imported.is_feature[h] != 0 && imported.twin[h] < h ? 1 : 0;
  }
  return edges;
}

TEST(FeatureNoise, IsALumpAmidNoiseButNoSpikeOnAFlat) {
  EXPECT_GE(edges_of_spike(0), 6);
  EXPECT_EQ(edges_of_spike(0.05), 0);
}

/// A dome with nine square panels, each of twelve edges with two of one edge that end at corners,
/// and rough ground along a flight of stairs where that is wanted.
TriMesh panels(bool with_stairs, std::vector<float>& roughness) {
  TriMesh mesh = flat_grid(40);
  for (int i = 0; i < 9; ++i) {
    const Vec3 at(6 + 12 * (i % 3), 6 + 12 * (i / 3), 0);  // NOLINT(bugprone-integer-division)
    std::vector<Vec3> loop = {at};
    for (const Vec3& side : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0), Vec3(0, -1, 0)}) {
      for (int k = 0; k < 3; ++k) loop.emplace_back(loop.back() + side);
    }
    draw(mesh, loop);
    draw(mesh, {at, at - Vec3(1, 0, 0)});
    draw(mesh, {at + Vec3(3, 3, 0), at + Vec3(4, 3, 0)});
  }
  roughness.assign(mesh.halfedge_count(), 0);
  if (with_stairs) {
    draw(mesh, stairs(4));
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Vec3& p = mesh.positions[mesh.from(h)];
      if (p.x() < 6 && p.y() < 6) roughness[h] = float(kRough);
    }
  }
  for (Vec3& p : mesh.positions) p.z() = -(p.head<2>() - Vec2(20, 20)).squaredNorm() / 30;
  mesh.diagonal *= 2;  // so that slopes make no edge too long to be cut off
  return mesh;
}

// Ends that are cut off are no noise, so the rest is not what that leaves of a crease.
TEST(FeatureNoise, WhatIsLeftIsFrayedOnlyWhereLinesWereNoise) {
  std::vector<float> roughness;
  TriMesh designed = panels(false, roughness);
  EXPECT_EQ(import::drop_noise(designed, roughness), 2 * 9);
  TriMesh noisy = panels(true, roughness);
  EXPECT_GT(import::drop_noise(noisy, roughness), 100);
}

}  // namespace
}  // namespace strake
