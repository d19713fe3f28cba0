#include "stages/fit/fit.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <array>
#include <cmath>
#include <map>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "tests/support/chain.h"
#include "tests/support/matchers.h"
#include "tests/support/mesh_support.h"
#include "tests/support/result_cases.h"
#include "tests/unit/fit/fit_cases.h"

namespace strake {
namespace {

using fit_cases::fitted;
using fit_cases::placed_on;

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

/// A coarse icosphere as a result on a fine one, turned so that nothing is equally near to two.
struct SphereCase {
  TriMesh mesh = support::plain_tri_mesh(icosphere(6));
  QuadMesh quads = placed_on(mesh, support::transformed(icosphere(2), support::oblique_rotation()));
};

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

/// Two such spheres at a distance, with coarse ones on them that are turned differently.
double ratio_of_two(double gap) {
  const auto shifted = [&](PolyMesh mesh) {
    for (Vec3& p : mesh.positions) p.x() += 2 + gap;
    return mesh;
  };
  const TriMesh mesh =
      support::plain_tri_mesh(support::together(icosphere(5), shifted(icosphere(5))));
  const PolyMesh coarse = support::transformed(icosphere(2), support::oblique_rotation());
  return ratio(mesh, placed_on(mesh, support::together(coarse, shifted(coarse))));
}

// Vertices near the other sphere cannot move all the way, but those around them can, and they
// themselves as far as there is room.
TEST(Fit, MovesVerticesAsNearToOtherSheetsAsItCan) {
  const double apart = ratio_of_two(1);
  EXPECT_LT(ratio_of_two(0.002), 1.1 * apart) << apart;
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

/// A coarse result of a sphere beside something a thousandth as large, before and after fitting.
class FitOfSpecks : public testing::Test {
 protected:
  void fit_beside_sphere(const PolyMesh& other) {
    SampleOptions sample;
    sample.faces = 2000;
    surface_ = support::prepare(support::together(
        make_sample(SampleKind::sphere, sample),
        support::transformed(other, 0.001 * support::oblique_rotation(), {2, 0, 0})));
    TraceOptions options;
    options.vertices = 100;
    before_ = support::mesh(surface_, support::trace(surface_, options));
    after_ = fit_cases::fitted_with_field(surface_, before_);
  }

  [[nodiscard]] static bool is_of_speck(const Vec3& place) { return place.x() > 1.5; }
  [[nodiscard]] static double speck_area(const PolyMesh& mesh) {
    double sum = 0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      if (!is_of_speck(mesh.positions[mesh.face(f)[0]])) continue;
      sum += newell_normal(mesh.positions, mesh.face(f)).norm() / 2;
    }
    return sum;
  }

  support::Prepared surface_;
  QuadMesh before_;
  QuadMesh after_;
};

TEST_F(FitOfSpecks, LeavesThemAsTheyAreWhereTheyAreTheInput) {
  PolyMesh tetrahedron;
  tetrahedron.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  for (const auto& face : {std::array<Index, 3>{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}) {
    tetrahedron.add_face(face);
  }
  fit_beside_sphere(tetrahedron);
  int held = 0;
  int moved = 0;
  for (Index v = 0; v < before_.mesh.vertex_count(); ++v) {
    const bool is_same = after_.mesh.positions[v] == before_.mesh.positions[v];
    if (is_of_speck(before_.mesh.positions[v]))
      held += is_same;
    else
      moved += !is_same;
  }
  EXPECT_EQ(held, 4);
  EXPECT_GT(moved, 50);
}

/// What directions are worth on what is a thousand times as large would fold them up.
TEST_F(FitOfSpecks, DoesNotFoldThemUp) {
  fit_beside_sphere(icosphere(2));
  const double given = 4 * M_PI * 1e-6;
  EXPECT_GT(speck_area(after_.mesh), 0.5 * given);
  EXPECT_LT(speck_area(after_.mesh), 2 * given);
}

// Every face meets those in its place, 17 with 18 copies, and each of these pairs counts for two.
TEST(Fit, LeavesManySheetsInOnePlaceAlone) {
  const TriMesh mesh = support::plain_tri_mesh(icosphere(5));
  const QuadMesh few = copies_on(mesh, 12);
  EXPECT_NE(fitted(mesh, few).mesh.positions, few.mesh.positions);
  const QuadMesh many = copies_on(mesh, 18);
  EXPECT_EQ(fitted(mesh, many).mesh.positions, many.mesh.positions);
}

/// Where sheets of the surface pass through each other so do faces; parting them would take some
/// off the surface, far beyond what they miss it by.
TEST(Fit, LeavesFacesThatCrossAsTheSurfaceDoesOnIt) {
  const auto bent = [](double x, double) { return 0.3 * x * x; };
  for (const double place : {0.85, 0.9, 0.95}) {
    const auto through = [&](double x, double y) { return bent(x, y) + 0.1 * (x - place); };
    const support::Case sheets = support::sheets(24, 6, {bent, through});
    const auto largest = [&](const QuadMesh& quads) {
      return measure_cells(ComparedSurfaces(sheets.mesh, quads)).largest;
    };
    EXPECT_LT(largest(fitted(sheets.mesh, sheets.quads)), 2 * largest(sheets.quads));
  }
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

INSTANTIATE_TEST_SUITE_P(Samples, FitOfSamples,
                         testing::Values(SampleKind::plane, SampleKind::torus, SampleKind::cylinder,
                                         SampleKind::part));

}  // namespace
}  // namespace strake
