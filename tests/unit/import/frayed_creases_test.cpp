#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::imported;

/// Round terraces, whose edges run across the faces of a grid.
PolyMesh round_terraces(int n) {
  return shapes::grid(n, n, [](double x, double y) {
    const double k = 8 * std::hypot(x - 0.4, 0.7 * (y - 0.45));
    return 0.04 * (std::floor(k) + std::clamp(6 * (k - std::floor(k)) - 5, 0.0, 1.0));
  });
}

/// Steps along the rows of a grid, of two edges each.
PolyMesh grid_steps(int n, int count) {
  return shapes::grid(n, n,
                      [&](double, double y) { return 2.0 / n * std::floor(y * (count - 1e-9)); });
}

/// Ditches on rough ground, whose walls go from point to point askew over a grid.
PolyMesh ditches(int n, int count) {
  return shapes::grid(n, n, [&](double x, double y) {
    const double rough = 0.2 / n * std::sin(12.9898 * n * x + 78.233 * n * y);
    return rough + (std::fmod(count * (x + 0.6 * y), 2) < 1 ? 0 : 10.0 / n);
  });
}

/// Half of a round bar.
PolyMesh half_bar(int sides, double radius) {
  PolyMesh mesh;
  std::vector<Index> top;
  for (Index i = 0; i <= sides; ++i) {
    const double angle = std::numbers::pi * i / sides;
    const Vec3 p(radius * std::cos(angle), radius * std::sin(angle), 0);
    mesh.positions.push_back(p);
    mesh.positions.push_back(p + Vec3(0, 0, 2 * radius));
    top.push_back(2 * i + 1);
  }
  mesh.add_face(top);
  std::vector<Index> bottom(top.rbegin(), top.rend());
  for (Index& v : bottom) --v;
  mesh.add_face(bottom);
  for (Index i = 0; i <= sides; ++i) {
    const Index next = (i + 1) % (sides + 1);
    mesh.add_face(std::array<Index, 4>{2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
  }
  return mesh;
}

PolyMesh shifted(PolyMesh mesh, double x) {
  for (Vec3& p : mesh.positions) p.x() += x;
  return mesh;
}

// Bits of edges that are bent enough by chance are no creases; those along the faces stay, and
// those of what has no such bits.
TEST(FrayedCreases, GoButNotThoseAlongTheFacesNorOfOtherParts) {
  constexpr int kSize = 120;
  constexpr int kSteps = 6;
  constexpr int kSides = 12;
  const PolyMesh sheets =
      support::together(round_terraces(kSize), shifted(grid_steps(kSize, kSteps), 2));
  const ImportResult result =
      imported(support::together(sheets, shifted(half_bar(kSides, 0.05), 4)));
  Index askew = 0;
  Index along = 0;
  Index of_bar = 0;
  for (Index h = 0; h < result.mesh.halfedge_count(); ++h) {
    if (result.mesh.is_feature[h] == 0 || h > result.mesh.twin[h]) continue;
    const double x = result.mesh.positions[result.mesh.from(h)].x() + result.mesh.origin.x();
    ++(x < 1.5 ? askew : x < 3.5 ? along : of_bar);
  }
  EXPECT_EQ(along, 2 * kSize * (kSteps - 1));
  EXPECT_EQ(of_bar, 2 * (kSides + 1) + 2);
  EXPECT_GT(shapes::count(result.report, "features.strong_edges") - along, 500);
  EXPECT_LT(askew, 200);
  EXPECT_LT(shapes::count(result.report, "features.corners"), 50);
}

TEST(JaggedCreases, StayWhereAllAreWantedAndAreToldOfWhereNot) {
  const PolyMesh ground = ditches(120, 20);
  const auto tells = [](const ImportResult& result) {
    return std::ranges::any_of(result.report.warnings(), [](const std::string& warning) {
      return warning.find("--all-creases") != std::string::npos;
    });
  };
  const ImportResult fewer = imported(ground);
  EXPECT_GT(shapes::count(fewer.report, "features.dropped_edges"), 500);
  EXPECT_TRUE(tells(fewer));
  const ImportResult all = imported(ground, {.all_creases = true});
  EXPECT_EQ(shapes::count(all.report, "features.dropped_edges"), 0);
  EXPECT_EQ(shapes::count(all.report, "features.edges"),
            shapes::count(all.report, "features.strong_edges") +
                shapes::count(all.report, "features.shallow_edges") +
                shapes::count(all.report, "features.bridging_edges"));
  EXPECT_FALSE(tells(all));
}

}  // namespace
}  // namespace strake
