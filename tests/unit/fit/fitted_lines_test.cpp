#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "stages/fit/fit.h"
#include "tests/support/chain.h"
#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/fit/fit_cases.h"

namespace strake {
namespace {

using fit_cases::fitted;
using fit_cases::fitted_with_field;
using fit_cases::placed_on;

/// Mean angle between the edges of a result and the nearer of two directions, degrees.
/// \param directions_at  the two directions at the middle of an edge
template <class DirectionsAt>
double mean_turn(const PolyMesh& mesh, const DirectionsAt& directions_at) {
  double sum = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& p = mesh.positions[face[i]];
      const Vec3 way = mesh.positions[face[(i + 1) % face.size()]] - p;
      const std::array<Vec3, 2> directions = directions_at(Vec3(p + way / 2));
      sum += std::min(support::line_angle(way, directions[0]),
                      support::line_angle(way, directions[1]));
    }
  }
  return sum / static_cast<double>(mesh.corners.size()) * 180 / M_PI;
}

/// From the two circles of the torus around z whose tube has its middle at distance `major`.
double turn_on_torus(const PolyMesh& mesh, double major) {
  return mean_turn(mesh, [&](const Vec3& middle) {
    const Vec3 out = Vec3(middle.x(), middle.y(), 0).normalized();
    const Vec3 around = Vec3::UnitZ().cross(out);
    return std::array<Vec3, 2>{around, (middle - major * out).normalized().cross(around)};
  });
}

/// From axis and circle of the cylinder around z.
double turn_on_cylinder(const PolyMesh& mesh) {
  return mean_turn(mesh, [](const Vec3& middle) {
    return std::array<Vec3, 2>{Vec3::UnitZ(), Vec3(-middle.y(), middle.x(), 0)};
  });
}

// Quads along the circles of a torus, every vertex shaken on the surface: with the field edges turn
// back to the circles, though their places among them stay free.
TEST(Fit, TurnsEdgesTowardsTheField) {
  const double major = 1;
  const double minor = 0.4;
  const auto at = [&](double s, double t) {
    return Vec3((major + minor * std::cos(t)) * std::cos(s),
                (major + minor * std::cos(t)) * std::sin(s), minor * std::sin(t));
  };
  const auto grid = [&](Index n, Index m, double shake) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> unit(-shake, shake);
    PolyMesh mesh;
    for (Index i = 0; i < n; ++i) {
      for (Index j = 0; j < m; ++j) {
        const double s = 2 * M_PI * (i + unit(random)) / n;
        const double t = 2 * M_PI * (j + unit(random)) / m;
        mesh.positions.push_back(at(s, t));
        const Index i1 = (i + 1) % n;
        const Index j1 = (j + 1) % m;
        mesh.add_face(std::vector<Index>{i * m + j, i1 * m + j, i1 * m + j1, i * m + j1});
      }
    }
    return mesh;
  };
  const support::Prepared surface = support::prepare(grid(160, 80, 0));
  const QuadMesh shaken = placed_on(surface.mesh, grid(40, 20, 0.15));
  SilentObserver observer;
  const QuadMesh with = fit_vertices(surface.mesh, &surface.field, shaken, {}, observer).quads;
  const double before = turn_on_torus(shaken.mesh, major);
  EXPECT_GT(before, 5);
  EXPECT_LT(turn_on_torus(with.mesh, major), 0.3 * before);
  EXPECT_LT(turn_on_torus(with.mesh, major),
            turn_on_torus(fitted(surface.mesh, shaken).mesh, major));
}

// Where a result is nearly as fine as the triangles that it was made from, it could still win by
// following their edges. Lines of curvature stay straight instead.
TEST(Fit, DoesNotBendLinesToTheEdgesOfATessellation) {
  SampleOptions options;
  options.faces = 6000;
  const support::Prepared surface =
      support::prepare(make_sample(SampleKind::open_cylinder, options));
  constexpr Index kAround = 120;
  constexpr Index kAlong = 10;
  PolyMesh grid;
  for (Index i = 0; i < kAround; ++i) {
    const double angle = 2 * M_PI * i / kAround;
    for (Index j = 0; j <= kAlong; ++j) {
      const double z = kCylinderHalfHeight * (2.0 * j / kAlong - 1);
      grid.positions.emplace_back(std::cos(angle), std::sin(angle), z);
      if (j == kAlong) continue;
      const Index at = i * (kAlong + 1) + j;
      const Index next = (i + 1) % kAround * (kAlong + 1) + j;
      grid.add_face(std::vector<Index>{at, next, next + 1, at + 1});
    }
  }
  const QuadMesh quads = placed_on(surface.mesh, grid);
  SilentObserver observer;
  const QuadMesh result = fit_vertices(surface.mesh, &surface.field, quads, {}, observer).quads;
  EXPECT_NE(result.mesh.positions, quads.mesh.positions);
  EXPECT_LT(turn_on_cylinder(result.mesh), 0.6);
}

/// Points of the rectangle [0, width] x [0, 1] on a plane, or on a cylinder around an axis along x.
struct Sheet {
  double width;
  double curvature;

  [[nodiscard]] Vec3 at(double x, double y) const {
    if (curvature == 0) return {x, y, 0};
    return {x, std::sin(curvature * y) / curvature, std::cos(curvature * y) / curvature};
  }
  /// A grid of quads with lines at the shares `x` of the width and `y` of the height.
  [[nodiscard]] PolyMesh grid(const std::vector<double>& x, const std::vector<double>& y) const {
    PolyMesh mesh;
    const auto n = static_cast<Index>(x.size());
    for (std::size_t j = 0; j < y.size(); ++j) {
      for (const double share : x) mesh.positions.push_back(at(width * share, y[j]));
    }
    for (Index j = 0; j + 1 < static_cast<Index>(y.size()); ++j) {
      for (Index i = 0; i + 1 < n; ++i) {
        const Index v = j * n + i;
        mesh.add_face(std::vector<Index>{v, v + 1, v + n + 1, v + n});
      }
    }
    return mesh;
  }
  /// What is remeshed.
  [[nodiscard]] support::Prepared surface() const {
    std::vector<double> shares;
    for (int i = 0; i <= 60; ++i) shares.push_back(i / 60.0);
    return support::prepare(grid(shares, shares));
  }
};

// Lines keep half to whole distances between them when they are traced.
TEST(Fit, SpacesLinesEvenlyWhereItIsFlat) {
  const Sheet sheet{1, 0};
  const support::Prepared surface = sheet.surface();
  const std::vector<double> lines = {0, 0.05, 0.15, 0.2, 0.3, 0.4, 0.45, 0.55, 0.6, 0.7, 0.8, 1};
  const QuadMesh result =
      fitted_with_field(surface, placed_on(surface.mesh, sheet.grid(lines, lines)));
  double longest = 0;
  double shortest = 1;
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    const std::span<const Index> face = result.mesh.face(f);
    for (std::size_t i = 0; i < 4; ++i) {
      const double length =
          (result.mesh.positions[face[(i + 1) % 4]] - result.mesh.positions[face[i]]).norm();
      longest = std::max(longest, length);
      shortest = std::min(shortest, length);
    }
  }
  EXPECT_LT(longest, 1.35 * shortest);  // 3.2 times before
}

// Two lines are drawn to each edge between facets. What is near stops a vertex on the way there
// only, and not on its way along these lines.
TEST(Fit, LinesStayStraightAcrossOthersThatAreNear) {
  const Sheet sheet{1, 2};
  std::vector<double> facets;
  for (int i = 0; i <= 8; ++i) facets.push_back(i / 8.0);
  const support::Prepared surface = support::prepare(sheet.grid({0, 0.25, 0.5, 0.75, 1}, facets));
  const std::vector<double> rows = {0,    0.12, 0.13, 0.25, 0.37, 0.38, 0.5,
                                    0.62, 0.63, 0.75, 0.87, 0.88, 1};
  const QuadMesh result =
      fitted_with_field(surface, placed_on(surface.mesh, sheet.grid({0, 0.2, 1}, rows)));
  double least = 1;
  double most = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    least = std::min(least, result.mesh.positions[3 * i + 1].x());
    most = std::max(most, result.mesh.positions[3 * i + 1].x());
  }
  EXPECT_GT(least, 0.49);
  EXPECT_LT(most - least, 1e-3);
}

/// The angle, degrees, at a T-joint that is a corner of a quad, after the fit: two quads at its
/// left, a quad in the shape of a triangle at its right.
double angle_at_joint(const Sheet& sheet) {
  PolyMesh mesh;
  for (const auto& [x, y] : {std::pair{0.0, 0.0},
                             {0.0, 0.5},
                             {0.0, 1.0},
                             {1.0, 0.0},
                             {1.0, 0.5},
                             {1.0, 1.0},
                             {2.0, 0.5},
                             {3.0, 0.0},
                             {3.0, 1.0}}) {
    mesh.positions.push_back(sheet.at(x, y));
  }
  mesh.add_face(std::vector<Index>{0, 3, 4, 1});
  mesh.add_face(std::vector<Index>{1, 4, 5, 2});
  mesh.add_face(std::vector<Index>{3, 6, 5, 4});
  mesh.add_face(std::vector<Index>{3, 7, 6});
  mesh.add_face(std::vector<Index>{7, 8, 6});
  mesh.add_face(std::vector<Index>{6, 8, 5});
  const support::Prepared surface = sheet.surface();
  const std::vector<Vec3> p =
      fitted_with_field(surface, placed_on(surface.mesh, mesh)).mesh.positions;
  const Vec3 below = p[3] - p[4];
  const Vec3 above = p[5] - p[4];
  return std::atan2(below.cross(above).norm(), below.dot(above)) * 180 / M_PI;
}

TEST(Fit, BendsTJointsOutOfQuadsWhereDirectionsMeanLittle) {
  const double flat = angle_at_joint({3, 0});
  EXPECT_LT(flat, 160);
  EXPECT_GT(flat, 100);
  EXPECT_GT(angle_at_joint({3, 0.2}), 170);  // across a cylinder, so much finer than it is bent
}

/// The root mean square distance of chords of a circle, over that of as many equal ones.
double unevenness(std::vector<double> angles) {
  std::sort(angles.begin(), angles.end());
  double sum = 0;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool is_last = i + 1 == angles.size();
    sum += std::pow(is_last ? angles[0] + 2 * M_PI - angles[i] : angles[i + 1] - angles[i], 5);
  }
  const double mean = 2 * M_PI / static_cast<double>(angles.size());
  return std::sqrt(sum / (2 * M_PI)) / (mean * mean);
}

// Directions of a flat disk mean nothing; the lines of the wall around it, which end at the same
// vertices, do, and crowding them costs distance.
TEST(Fit, AFlatDiskDoesNotCrowdTheLinesAroundIt) {
  SampleOptions sample;
  sample.faces = 20000;
  const support::Prepared surface = support::prepare(make_sample(SampleKind::cylinder, sample));
  TraceOptions trace;
  trace.vertices = 500;
  const QuadMesh result =
      fitted_with_field(surface, support::mesh(surface, support::trace(surface, trace)));
  for (const double end : {-kCylinderHalfHeight, kCylinderHalfHeight}) {
    std::vector<double> angles;
    for (const Vec3& p : result.mesh.positions) {
      if (std::abs(p.z() - end) > 1e-3 || p.head<2>().norm() < 0.99) continue;
      angles.push_back(std::atan2(p.y(), p.x()));
    }
    ASSERT_GT(angles.size(), 20u);
    EXPECT_LT(unevenness(angles), 1.2);
  }
}

/// A flat ring of quads between radii of 1/2 and 1, lines at these angles.
PolyMesh flat_ring(const std::vector<double>& angles, Index rows) {
  PolyMesh mesh;
  const auto n = static_cast<Index>(angles.size());
  for (Index j = 0; j <= rows; ++j) {
    const double radius = 0.5 + 0.5 * j / rows;
    for (const double angle : angles) {
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index next = (i + 1) % n;
      mesh.add_face(
          std::vector<Index>{j * n + i, (j + 1) * n + i, (j + 1) * n + next, j * n + next});
    }
  }
  return mesh;
}

// No face of a flat ring is off the surface, but long edges cut off much of its outlines.
TEST(Fit, KeepsToTheOutlineOfAFlat) {
  std::vector<double> even;
  for (int i = 0; i < 240; ++i) even.push_back(2 * M_PI * i / 240);
  std::vector<double> uneven;
  for (int i = 0; i < 24; ++i) uneven.push_back(2 * M_PI * (i + (i % 2 == 0 ? 0.2 : -0.2)) / 24);
  const support::Prepared surface = support::prepare(flat_ring(even, 20));
  const QuadMesh result = fitted(surface.mesh, placed_on(surface.mesh, flat_ring(uneven, 1)));
  for (const double radius : {0.5, 1.0}) {
    std::vector<double> angles;
    for (const Vec3& p : result.mesh.positions) {
      if (std::abs(p.norm() - radius) < 1e-2) angles.push_back(std::atan2(p.y(), p.x()));
    }
    ASSERT_EQ(angles.size(), 24u);
    EXPECT_LT(unevenness(angles), 1.05) << radius;
  }
  EXPECT_GT(unevenness(uneven), 1.4);
}

}  // namespace
}  // namespace strake
