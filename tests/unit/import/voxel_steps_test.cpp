#include "stages/import/voxel_steps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using Voxel = std::array<int, 3>;

/// The outer sides of the voxels that are inside, of n x n x n. \param size  of one
PolyMesh boxes(int n, const Vec3& size, const std::function<bool(const Voxel&)>& is_inside) {
  PolyMesh mesh;
  std::map<Voxel, Index> numbers;
  const auto vertex = [&](const Voxel& at) {
    const auto [entry, is_new] = numbers.try_emplace(at, mesh.vertex_count());
    if (is_new) mesh.positions.push_back(Vec3(at[0], at[1], at[2]).cwiseProduct(size));
    return entry->second;
  };
  const auto is_full = [&](const Voxel& at) {
    return std::ranges::all_of(at, [&](int k) { return k >= 0 && k < n; }) && is_inside(at);
  };
  for (int i = 0; i < n * n * n; ++i) {
    const Voxel at = {i % n, i / n % n, i / n / n};
    if (!is_full(at)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        Voxel beside = at;
        beside[axis] += 2 * side - 1;
        if (is_full(beside)) continue;
        std::vector<Index> face;
        for (const auto& [u, v] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          Voxel corner = at;
          corner[axis] += side;
          corner[(axis + 1) % 3] += side == 1 ? u : v;
          corner[(axis + 2) % 3] += side == 1 ? v : u;
          face.push_back(vertex(corner));
        }
        mesh.add_face(face);
      }
    }
  }
  return mesh;
}

bool is_in_ball(const Voxel& at, int n) {
  const auto square = [&](int k) { return std::pow(k + 0.5 - 0.5 * n, 2); };
  return square(at[0]) + square(at[1]) + square(at[2]) < 0.24 * n * n;
}

bool has_steps(const PolyMesh& mesh) {
  return import::has_voxel_steps(shapes::imported(mesh, shapes::undivided()).mesh);
}

TEST(VoxelSteps, AreFoundOnAGridOfAnySpacing) {
  constexpr int kSize = 24;
  const auto ball = [](const Voxel& at) { return is_in_ball(at, kSize); };
  EXPECT_TRUE(has_steps(boxes(kSize, Vec3(1, 1, 1), ball)));
  EXPECT_TRUE(has_steps(boxes(kSize, Vec3(0.7, 0.7, 3), ball)));
  const PolyMesh away = support::transformed(boxes(kSize, Vec3(1, 1, 1), ball),
                                             1e-3 * Mat3::Identity(), Vec3(5, 6, 7));
  EXPECT_TRUE(has_steps(away));
}

TEST(VoxelSteps, HeightsInWholeStepsHaveThem) {
  const auto wave = [](double x, double y) { return 0.5 * std::sin(4 * x) * std::cos(5 * y); };
  const auto in_steps = [&](double x, double y) { return 0.05 * std::round(wave(x, y) / 0.05); };
  EXPECT_TRUE(has_steps(shapes::grid(40, 40, in_steps)));
  EXPECT_FALSE(has_steps(shapes::grid(40, 40, wave)));
}

TEST(VoxelSteps, AreNoneOfPartsAndSmoothSurfaces) {
  EXPECT_FALSE(has_steps(boxes(12, Vec3(1, 1, 1), [](const Voxel&) { return true; })));
  for (const SampleKind kind : {SampleKind::sphere, SampleKind::torus, SampleKind::part}) {
    SampleOptions options;
    options.faces = 3000;
    EXPECT_FALSE(has_steps(make_sample(kind, options)));
  }
}

/// Rounds of smoothing take them off by themselves, and nobody says that the surface was not rough.
TEST(VoxelSteps, AreTakenOffWithoutMoreAdo) {
  constexpr int kSize = 24;
  const PolyMesh mesh =
      boxes(kSize, Vec3(1, 1, 1), [](const Voxel& at) { return is_in_ball(at, kSize); });
  ImportOptions options = shapes::undivided();
  const auto says = [&](const ImportResult& result, const char* part) {
    return std::ranges::any_of(result.report.warnings(), [&](const std::string& warning) {
      return warning.find(part) != std::string::npos;
    });
  };
  const ImportResult before = shapes::imported(mesh, options);
  EXPECT_TRUE(says(before, "lie on a grid"));
  EXPECT_GT(shapes::count(before.report, "features.edges"), 1000);
  options.denoise = 20;
  const ImportResult after = shapes::imported(mesh, options);
  EXPECT_TRUE(after.report.warnings().empty());
  EXPECT_EQ(shapes::count(after.report, "features.edges"), 0);
  EXPECT_NEAR(shapes::volume(after.mesh), shapes::volume(before.mesh),
              0.02 * shapes::volume(before.mesh));
}

}  // namespace
}  // namespace strake
