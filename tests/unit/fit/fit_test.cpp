#include "stages/fit/fit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <map>
#include <random>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "tests/support/chain.h"
#include "tests/support/matchers.h"
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

/// A polygon mesh as a result, each vertex put on the nearest point of the mesh.
QuadMesh placed_on(const TriMesh& mesh, PolyMesh result) {
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  QuadMesh quads;
  for (Vec3& p : result.positions) {
    const ClosestPoint nearest = surface.closest(p);
    p = surface.point(nearest);
    quads.provenance.face.push_back(nearest.triangle);
    quads.provenance.barycentric.push_back(nearest.barycentric);
    quads.provenance.lines.push_back({kNone, kNone});
  }
  quads.mesh = std::move(result);
  return quads;
}

/// A coarse icosphere as a result on a fine one, turned so that nothing is equally near to two.
struct SphereCase {
  TriMesh mesh = support::plain_tri_mesh(icosphere(6));
  QuadMesh quads = placed_on(mesh, support::transformed(icosphere(2), support::oblique_rotation()));
};

QuadMesh fitted(const TriMesh& mesh, const QuadMesh& quads, std::int64_t rounds = 6) {
  SilentObserver observer;
  FitOptions options;
  options.rounds = rounds;
  return fit_vertices(mesh, nullptr, quads, options, observer).quads;
}

double ratio(const TriMesh& mesh, const QuadMesh& quads) {
  SilentObserver observer;
  const FitResult result = fit_vertices(mesh, nullptr, quads, {}, observer);
  for (const auto& [key, value] : result.report.entries()) {
    if (key == "fit.rms_ratio") return std::get<double>(value);
  }
  return NAN;
}

// Over an equilateral triangle between points of a sphere the distance is, to leading order,
// proportional to q = ab + bc + ca in barycentric coordinates: mean 1/4, mean square 1/15. A common
// shift removes the mean, so the root mean square falls to sqrt((1/15 - 1/16) / (1/15)) = 1/4. The
// edges of the icosphere differ by 18 %, so q differs by 40 % between triangles. Vertices that move
// on the surface make up for part of that: 0.2 to 0.35 leaves room for it.
TEST(Fit, ShiftsAnInscribedSphereByItsMeanDistance) {
  const SphereCase sphere;
  EXPECT_LT(ratio(sphere.mesh, sphere.quads), 0.35);
  EXPECT_GT(ratio(sphere.mesh, sphere.quads), 0.2);
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

TEST(Fit, TurnsWithTheModel) {
  const SphereCase sphere;
  const QuadMesh plain = fitted(sphere.mesh, sphere.quads);
  SphereCase turned;
  const Mat3 rotation = support::oblique_rotation();
  for (Vec3& p : turned.mesh.positions) p = rotation * p;
  for (Vec3& p : turned.quads.mesh.positions) p = rotation * p;
  const QuadMesh result = fitted(turned.mesh, turned.quads);
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    EXPECT_TRUE(support::near(result.mesh.positions[v], rotation * plain.mesh.positions[v], 1e-7));
  }
}

// What lies in a plane may be spread out there, but stays in it.
TEST(Fit, KeepsAResultInThePlane) {
  SampleOptions options;
  options.faces = 5000;
  const PolyMesh fine = make_sample(SampleKind::plane, options);
  options.faces = 500;
  const PolyMesh coarse = make_sample(SampleKind::plane, options);
  const TriMesh level = support::plain_tri_mesh(fine);
  const QuadMesh flat = fitted(level, placed_on(level, coarse));
  for (const Vec3& p : flat.mesh.positions) EXPECT_EQ(p.z(), coarse.positions[0].z());
  const Mat3 rotation = support::oblique_rotation();
  const TriMesh oblique = support::plain_tri_mesh(support::transformed(fine, rotation));
  const QuadMesh turned =
      fitted(oblique, placed_on(oblique, support::transformed(coarse, rotation)));
  for (const Vec3& p : turned.mesh.positions) {
    EXPECT_NEAR((rotation.transpose() * p).z(), coarse.positions[0].z(), 1e-12);
  }
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

QuadMesh fitted_with_field(const support::Prepared& surface, const QuadMesh& quads) {
  SilentObserver observer;
  return fit_vertices(surface.mesh, &surface.field, quads, {}, observer).quads;
}

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
  EXPECT_GT(flat, 130);
  EXPECT_GT(angle_at_joint({3, 0.2}), 170);  // across a cylinder, so much finer than it is bent
}

TEST(Fit, NoRoundsChangeNothing) {
  const SphereCase sphere;
  EXPECT_EQ(fitted(sphere.mesh, sphere.quads, 0).mesh.positions, sphere.quads.mesh.positions);
}

/// So many icospheres in one place, as a result on the fine sphere.
QuadMesh copies_on(const TriMesh& mesh, int copies) {
  const PolyMesh coarse = support::transformed(icosphere(1), support::oblique_rotation());
  PolyMesh all;
  for (int copy = 0; copy < copies; ++copy) {
    const Index first = all.vertex_count();
    all.positions.insert(all.positions.end(), coarse.positions.begin(), coarse.positions.end());
    for (Index f = 0; f < coarse.face_count(); ++f) {
      std::vector<Index> corners(coarse.face(f).begin(), coarse.face(f).end());
      for (Index& v : corners) v += first;
      all.add_face(corners);
    }
  }
  return placed_on(mesh, all);
}

// Every face meets those in its place, 17 with 18 copies, and each of these pairs counts for two.
TEST(Fit, LeavesManySheetsInOnePlaceAlone) {
  const TriMesh mesh = support::plain_tri_mesh(icosphere(5));
  const QuadMesh few = copies_on(mesh, 12);
  EXPECT_NE(fitted(mesh, few).mesh.positions, few.mesh.positions);
  const QuadMesh many = copies_on(mesh, 18);
  EXPECT_EQ(fitted(mesh, many).mesh.positions, many.mesh.positions);
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
    options.faces = 6000;
    surface_ = support::prepare(make_sample(GetParam(), options));
    TraceOptions trace;
    trace.vertices = 1000;  // no faces cross that would be made anew, with other numbers
    quads_ = support::mesh(surface_, support::trace(surface_, trace));
  }

  support::Prepared surface_;
  QuadMesh quads_;
};

/// Where a vertex's provenance says that it belongs.
Vec3 foot(const TriMesh& mesh, const QuadMesh& quads, Index v) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    sum += quads.provenance.barycentric[v][i] *
           mesh.positions[mesh.faces[quads.provenance.face[v]][i]];
  }
  return sum + mesh.origin;
}

/// Whether the foot of a vertex lies on a feature or boundary edge of its face, or at their corner.
enum class On { surface, line, corner };
On place_of(const TriMesh& mesh, const QuadMesh& quads, Index v) {
  const Index face = quads.provenance.face[v];
  const auto& at = quads.provenance.barycentric[v];
  for (int i = 0; i < 3; ++i) {
    if (at[i] > 1 - 1e-9 && mesh.is_corner[mesh.faces[face][i]] != 0) return On::corner;
  }
  for (int i = 0; i < 3; ++i) {
    if (at[i] < 1e-9 && mesh.is_barrier(3 * face + (i + 1) % 3)) return On::line;
  }
  return On::surface;
}

TEST_P(FitOfSamples, KeepsCornersAndSlidesAlongFeaturesAndBoundaries) {
  const TriMesh& mesh = surface_.mesh;
  const QuadMesh result = fitted(mesh, quads_);
  int on_lines = 0;
  int moved = 0;
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    const On place = place_of(mesh, quads_, v);
    if (place == On::surface) continue;
    ++on_lines;
    if (place == On::corner) {
      EXPECT_EQ(result.mesh.positions[v], quads_.mesh.positions[v]) << v;
      continue;
    }
    EXPECT_NE(place_of(mesh, result, v), On::surface) << v;
    EXPECT_TRUE(support::near(result.mesh.positions[v], foot(mesh, result, v), 1e-12)) << v;
    moved += result.mesh.positions[v] != quads_.mesh.positions[v] ? 1 : 0;
  }
  const bool has_lines = GetParam() != SampleKind::torus;
  EXPECT_EQ(on_lines > 0, has_lines);
  if (GetParam() == SampleKind::part) {
    EXPECT_GT(moved, 0);
  }
}

// None of these samples has another sheet nearer to a vertex than its own.
TEST_P(FitOfSamples, KeepsTheFootOfEveryVertex) {
  const TriMesh& mesh = surface_.mesh;
  const QuadMesh result = fitted(mesh, quads_);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    const Vec3 p = result.mesh.positions[v];
    const double distance = (p - foot(mesh, result, v)).norm();
    EXPECT_NEAR(distance, surface.closest(p - mesh.origin).distance, 1e-12 * mesh.diagonal) << v;
  }
}

TEST_P(FitOfSamples, NeverIncreasesTheDistanceNorSpoilsFaces) {
  const double improved = ratio(surface_.mesh, quads_);
  if (GetParam() != SampleKind::plane) {
    EXPECT_LT(improved, 0.9);
  }
  const QuadMesh result = fitted(surface_.mesh, quads_);
  EXPECT_GE(result.mesh.face_count(), quads_.mesh.face_count());  // some may have been divided
  EXPECT_EQ(analyse(result.mesh).euler, analyse(quads_.mesh).euler);
  for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
    if (is_concave_face(quads_.mesh.positions, quads_.mesh.face(f))) continue;
    EXPECT_FALSE(is_concave_face(result.mesh.positions, result.mesh.face(f))) << f;
    EXPECT_GT(newell_normal(result.mesh.positions, result.mesh.face(f))
                  .dot(newell_normal(quads_.mesh.positions, quads_.mesh.face(f))),
              0)
        << f;
  }
  const auto crossings = [](const PolyMesh& polygons) {
    return find_crossing_faces(polygons.positions, triangulate_faces(polygons)).size();
  };
  EXPECT_LE(crossings(result.mesh), crossings(quads_.mesh));
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

INSTANTIATE_TEST_SUITE_P(Samples, FitOfSamples,
                         testing::Values(SampleKind::plane, SampleKind::torus, SampleKind::cylinder,
                                         SampleKind::part));

}  // namespace
}  // namespace strake
