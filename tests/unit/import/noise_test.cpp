#include "stages/import/noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <utility>

#include "common/geometry/samples/samples.h"
#include "stages/import/import.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using import::measure_noise;
using import::take_noise_off;

PolyMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return make_sample(kind, options);
}

/// Moves all vertices at random, by `share` of the mean edge length in each direction.
void add_noise(PolyMesh& mesh, double share) {
  std::mt19937 random(1);
  const double length = support::mean_edge_length(support::plain_tri_mesh(mesh));
  std::normal_distribution<double> noise(0, share * length);
  for (Vec3& p : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) p[axis] += noise(random);
  }
}

struct Radii {
  double mean = 0;
  double deviation = 0;
};

Radii radii_of(const TriMesh& mesh) {
  Radii radii;
  const auto count = static_cast<double>(mesh.positions.size());
  for (const Vec3& p : mesh.positions) radii.mean += p.norm() / count;
  for (const Vec3& p : mesh.positions) {
    radii.deviation += std::pow(p.norm() - radii.mean, 2) / count;
  }
  radii.deviation = std::sqrt(radii.deviation);
  return radii;
}

TEST(Noise, ShowsInBendsToAndFro) {
  for (const SampleKind kind : {SampleKind::sphere, SampleKind::torus, SampleKind::part}) {
    PolyMesh mesh = sample(kind, 8000);
    EXPECT_FALSE(measure_noise(support::plain_tri_mesh(mesh)).is_much());
    add_noise(mesh, 0.3);
    EXPECT_TRUE(measure_noise(support::plain_tri_mesh(mesh)).is_much());
  }
  // Coarse, not rough: all edges are bent to the same side.
  PolyMesh octahedron;
  octahedron.positions = {Vec3(1, 0, 0),  Vec3(-1, 0, 0), Vec3(0, 1, 0),
                          Vec3(0, -1, 0), Vec3(0, 0, 1),  Vec3(0, 0, -1)};
  for (const Index top : {4, 5}) {
    for (const auto& [a, b] : {std::pair{0, 2}, {2, 1}, {1, 3}, {3, 0}}) {
      octahedron.add_face(top == 4 ? std::array<Index, 3>{a, b, 4} : std::array<Index, 3>{b, a, 5});
    }
  }
  const import::Noise coarse = measure_noise(support::plain_tri_mesh(octahedron));
  EXPECT_NEAR(coarse.median_bend_deg, 70.5, 0.11);  // 180 less the dihedral angle
  EXPECT_NEAR(coarse.to_and_fro, 0, 1e-12);
  EXPECT_FALSE(coarse.is_much());
}

/// Edges across the lines of a scanner are bent, those along them hardly: length counts.
TEST(Noise, ShowsOnScanLines) {
  PolyMesh lines = shapes::grid(300, 20, [](double, double) { return 0.0; });
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.35 / 300);
  for (Vec3& p : lines.positions) p.z() += noise(random);
  EXPECT_TRUE(measure_noise(shapes::imported(lines).mesh).is_much());
}

/// A thread as it is extruded with a twist of 10 degrees a layer: the flanks of a profile of 60
/// points, as triangles.
PolyMesh thread() {
  constexpr int kRound = 60;
  constexpr int kLayers = 60;
  PolyMesh mesh;
  for (int layer = 0; layer <= kLayers; ++layer) {
    for (int i = 0; i < kRound; ++i) {
      const double off = std::abs((i + kRound / 2) % kRound - kRound / 2) / (0.5 * kRound);
      const double radius = 6 + 3 * std::clamp(4 * (0.62 - off), 0.0, 1.0);
      const double turn = 2 * std::numbers::pi * (i / double(kRound) - layer / 36.0);
      mesh.positions.emplace_back(radius * std::cos(turn), radius * std::sin(turn), layer / 6.0);
    }
  }
  for (int layer = 0; layer < kLayers; ++layer) {
    for (int i = 0; i < kRound; ++i) {
      const Index a = layer * kRound + i;
      const Index b = layer * kRound + (i + 1) % kRound;
      mesh.add_face(std::array<Index, 3>{a, b, b + kRound});
      mesh.add_face(std::array<Index, 3>{a, b + kRound, a + kRound});
    }
  }
  return mesh;
}

TEST(Noise, FacetsThatRepeatAreNone) {
  PolyMesh mesh = thread();
  const import::Noise facets = measure_noise(support::plain_tri_mesh(mesh));
  // Bent as much, and as much to and fro, as noise is.
  EXPECT_GT(facets.median_bend_deg, 20);
  EXPECT_GT(facets.to_and_fro, 0.75);
  EXPECT_GT(facets.repeated, 0.9);
  EXPECT_FALSE(facets.is_much());
  add_noise(mesh, 0.3);
  const import::Noise rough = measure_noise(support::plain_tri_mesh(mesh));
  EXPECT_LT(rough.repeated, 0.1);
  EXPECT_TRUE(rough.is_much());
}

TEST(Noise, IsMeasuredAlikeInAnyUnit) {
  PolyMesh mesh = sample(SampleKind::torus, 2000);
  add_noise(mesh, 0.2);
  const import::Noise here = measure_noise(support::plain_tri_mesh(mesh));
  const import::Noise there = measure_noise(support::plain_tri_mesh(
      support::transformed(mesh, 1e3 * support::oblique_rotation(), Vec3(1, 2, 3))));
  EXPECT_NEAR(there.median_bend_deg, here.median_bend_deg, 0.11);
  EXPECT_NEAR(there.to_and_fro, here.to_and_fro, 1e-9);
}

TEST(TakeNoiseOff, LeavesTheShape) {
  PolyMesh noisy = sample(SampleKind::sphere, 20000);
  const Radii exact = radii_of(support::plain_tri_mesh(noisy));
  add_noise(noisy, 0.3);
  TriMesh mesh = support::plain_tri_mesh(noisy);
  const Radii before = radii_of(mesh);
  const double moved = take_noise_off(mesh, 20).rms;
  const Radii after = radii_of(mesh);
  EXPECT_LT(after.deviation, before.deviation / 2.5);
  EXPECT_NEAR(after.mean, exact.mean, 0.002 * exact.mean);
  // By about the noise, as normals are hardly those of the sphere.
  EXPECT_GT(moved, before.deviation / 2);
  EXPECT_LT(moved, 2 * before.deviation);
  EXPECT_FALSE(measure_noise(mesh).is_much());
}

TEST(TakeNoiseOff, DoesLittleToASmoothSurface) {
  TriMesh mesh = support::plain_tri_mesh(sample(SampleKind::sphere, 20000));
  const Radii before = radii_of(mesh);
  take_noise_off(mesh, 20);
  EXPECT_NEAR(radii_of(mesh).mean, before.mean, 1e-3 * before.mean);
}

/// A ball with poles: 200 meridians, so that triangles near the poles are up to thirty times as
/// long as wide.
PolyMesh ball_of_meridians() {
  constexpr int kRound = 200;
  constexpr int kRings = 11;
  PolyMesh mesh;
  for (int ring = 1; ring <= kRings; ++ring) {
    const double polar = std::numbers::pi * ring / (kRings + 1);
    for (int i = 0; i < kRound; ++i) {
      const double turn = 2 * std::numbers::pi * i / kRound;
      mesh.positions.emplace_back(std::sin(polar) * std::cos(turn),
                                  std::sin(polar) * std::sin(turn), std::cos(polar));
    }
  }
  const Index north = mesh.vertex_count();
  mesh.positions.emplace_back(0, 0, 1);
  mesh.positions.emplace_back(0, 0, -1);
  const Index last = (kRings - 1) * kRound;
  for (Index i = 0; i < kRound; ++i) {
    const Index j = (i + 1) % kRound;
    mesh.add_face(std::array<Index, 3>{north, i, j});
    mesh.add_face(std::array<Index, 3>{north + 1, last + j, last + i});
    for (Index ring = 0; ring < last; ring += kRound) {
      mesh.add_face(std::array<Index, 3>{ring + i, ring + kRound + i, ring + kRound + j});
      mesh.add_face(std::array<Index, 3>{ring + i, ring + kRound + j, ring + j});
    }
  }
  return mesh;
}

/// Curvature is the same everywhere, whatever the triangles: nothing to be taken off. Uniform
/// weights move the rings beside the poles by 1.6 % of the radius.
TEST(TakeNoiseOff, LeavesLongTriangles) {
  TriMesh mesh = support::plain_tri_mesh(ball_of_meridians());
  take_noise_off(mesh, 10);
  for (const Vec3& p : mesh.positions) EXPECT_NEAR(p.norm(), 1, 0.003);
}

/// A coarse surface, all of whose vertices are on creases, stays: there is no noise along these.
TEST(TakeNoiseOff, LeavesCoarseCreases) {
  const PolyMesh folded = shapes::grid(
      20, 10, [](double x, double) { return std::lround(x * 20) % 2 == 0 ? 0.0 : 0.05; });
  TriMesh mesh = shapes::imported(folded).mesh;
  EXPECT_LT(take_noise_off(mesh, 10).largest, 1e-12);
}

/// Light noise on a roof: the ridge stays sharp, and is as smooth as the rest.
TEST(TakeNoiseOff, TakesItOffCreasesAlong) {
  constexpr int kCells = 40;
  PolyMesh roof = shapes::grid(kCells, kCells, [](double x, double) { return -std::abs(x - 0.5); });
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.05 / kCells);
  for (Vec3& p : roof.positions) p.z() += noise(random);
  TriMesh mesh = shapes::imported(roof).mesh;
  const auto deviations = [&] {  // of the ridge, of the rest
    std::array<double, 2> squares = {0, 0};
    std::array<double, 2> count = {0, 0};
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.is_boundary(mesh.vertex_out[v])) continue;
      const Vec3& p = mesh.positions[v];
      const int kind = std::abs(p.x() - 0.5) < 0.5 / kCells ? 0 : 1;
      squares[kind] += std::pow(p.z() + std::abs(p.x() - 0.5), 2);
      count[kind] += 1;
    }
    return std::array{std::sqrt(squares[0] / count[0]), std::sqrt(squares[1] / count[1])};
  };
  const std::array<double, 2> before = deviations();
  take_noise_off(mesh, 10);
  const std::array<double, 2> after = deviations();
  EXPECT_LT(after[0], 0.7 * before[0]);
  EXPECT_LT(after[1], 0.6 * before[1]);
}

/// The boundary of a plane, and that of a pinhole in it, stay where they are.
TEST(TakeNoiseOff, KeepsBoundaries) {
  const PolyMesh plane = sample(SampleKind::plane, 5000);
  PolyMesh holed;
  holed.positions = plane.positions;
  for (Index f = 0; f < plane.face_count(); ++f) {
    if (f != plane.face_count() / 2) holed.add_face(plane.face(f));
  }
  const TriMesh before = support::plain_tri_mesh(holed);
  TriMesh mesh = before;
  take_noise_off(mesh, 20);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(mesh.positions[v].z(), before.positions[v].z());
  }
  for (Index h = 0; h < before.halfedge_count(); ++h) {
    if (!before.is_boundary(h)) continue;
    const Index v = before.from(h);
    EXPECT_EQ(mesh.positions[v], before.positions[v]);
  }
}

TEST(TakeNoiseOff, TakesItOffBoundariesToo) {
  PolyMesh plane = sample(SampleKind::plane, 5000);
  const double edge = support::mean_edge_length(support::plain_tri_mesh(plane));
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0, 0.2 * edge);
  for (Vec3& p : plane.positions) p.z() = noise(random);
  const TriMesh before = support::plain_tri_mesh(plane);
  TriMesh mesh = before;
  take_noise_off(mesh, 20);
  double noisy = 0;
  double left = 0;
  for (Index h = 0; h < before.halfedge_count(); ++h) {
    if (!before.is_boundary(h)) continue;
    noisy += std::pow(before.positions[before.from(h)].z(), 2);
    left += std::pow(mesh.positions[before.from(h)].z(), 2);
  }
  EXPECT_LT(left, 0.5 * noisy);
}

TEST(TakeNoiseOff, LeavesTipsOfCones) {
  constexpr int kAround = 64;
  constexpr int kRings = 20;
  PolyMesh cone;
  cone.positions.emplace_back(0, 0, 1);
  for (int k = 1; k <= kRings; ++k) {
    for (int i = 0; i < kAround; ++i) {
      const double t = 2 * std::numbers::pi * i / kAround;
      const double r = 0.6 * k / kRings;
      cone.positions.emplace_back(r * std::cos(t), r * std::sin(t), 1 - double(k) / kRings);
    }
  }
  const auto at = [](int k, int i) { return 1 + (k - 1) * kAround + i % kAround; };
  for (int i = 0; i < kAround; ++i) {
    cone.add_face(std::array<Index, 3>{0, at(1, i), at(1, i + 1)});
    for (int k = 1; k < kRings; ++k) {
      cone.add_face(std::array<Index, 4>{at(k, i), at(k + 1, i), at(k + 1, i + 1), at(k, i + 1)});
    }
  }
  ImportOptions options = shapes::undivided();
  options.denoise = 10;
  const TriMesh mesh = shapes::imported(cone, options).mesh;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.source_vertex[v] != 0) continue;
    EXPECT_EQ(mesh.is_corner[v], 1);
    EXPECT_NEAR((mesh.positions[v] + mesh.origin).z(), 1, 1e-12);
  }
}

TEST(TakeNoiseOff, IsAskedForByAWarningAndAnOption) {
  PolyMesh noisy = sample(SampleKind::torus, 8000);
  add_noise(noisy, 0.3);
  SilentObserver observer;
  ImportOptions options;
  const auto is_warned_of = [&] {
    const auto warnings = import_mesh(noisy, options, observer).report.warnings();
    return std::ranges::any_of(
        warnings, [](const std::string& w) { return w.find("--denoise") != std::string::npos; });
  };
  EXPECT_TRUE(is_warned_of());
  options.denoise = 10;
  EXPECT_FALSE(is_warned_of());
}

/// A cube without creases becomes round, and so does what is coarse.
TEST(TakeNoiseOff, SaysWhenItMovesASurfaceThatIsNotRough) {
  SilentObserver observer;
  ImportOptions options;
  options.denoise = 10;
  const auto warnings_of = [&](const PolyMesh& mesh) {
    const auto warnings = import_mesh(mesh, options, observer).report.warnings();
    return std::ranges::count_if(
        warnings, [](const std::string& w) { return w.find("moved") != std::string::npos; });
  };
  EXPECT_EQ(warnings_of(shapes::cube()), 0);
  EXPECT_EQ(warnings_of(sample(SampleKind::sphere, 20000)), 0);
  options.feature_angle_deg = 180;
  EXPECT_EQ(warnings_of(shapes::cube()), 1);
}

}  // namespace
}  // namespace strake
