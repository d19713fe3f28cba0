#include "stages/refine/inlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/inlays.h"
#include "stages/refine/refine.h"
#include "stages/refine/surface_part.h"
#include "stages/refine/thinning.h"
#include "stages/refine/uncross.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;
using support::sheets;
using Triangles = std::vector<std::array<Index, 3>>;

double terrain(double x, double y) { return 0.05 * std::sin(9 * x) * std::cos(7 * y); }

/// Terrain with a needle amid a cell of 8 x 8.
Case needle() {
  return grid(32, 8, [](double x, double y) {
    return 0.2 * terrain(x, y) + (std::hypot(x - 0.59375, y - 0.46875) < 0.01 ? 0.4 : 0.0);
  });
}

Vec3 area_vector(const std::vector<Vec3>& positions, const std::array<Index, 3>& t) {
  return (positions[t[1]] - positions[t[0]]).cross(positions[t[2]] - positions[t[0]]) / 2;
}

double area(const std::vector<Vec3>& positions, const Triangles& triangles) {
  double sum = 0;
  for (const auto& t : triangles) sum += area_vector(positions, t).norm();
  return sum;
}

std::vector<Vec3> positions_of(const Inlay& inlay, const ComparedSurfaces& surfaces) {
  std::vector<Vec3> positions;
  for (const Index v : inlay.outline) positions.push_back(surfaces.positions()[v]);
  for (const SurfacePoint& p : inlay.points) positions.push_back(place_of(surfaces.mesh(), p));
  return positions;
}

TEST(SurfacePart, IsTheSurfaceWithShortEdgesInTheBox) {
  const Case c = grid(4, 4, terrain);
  const Eigen::AlignedBox3d box(Vec3(0.3, 0.3, -1), Vec3(0.7, 0.7, 1));
  const SurfacePart part = surface_part(c.mesh, {10}, box, 0.05, 10000);
  ASSERT_GT(part.faces.size(), 100u);
  double of_parents = 0;
  for (const Index f : std::set<Index>(part.parent.begin(), part.parent.end())) {
    of_parents += area_vector(c.mesh.positions, c.mesh.faces[f]).norm();
  }
  EXPECT_NEAR(area(part.positions, part.faces), of_parents, 1e-12);
  for (std::size_t v = 0; v < part.points.size(); ++v) {
    EXPECT_LT((place_of(c.mesh, part.points[v]) - part.positions[v]).norm(), 1e-12);
  }
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3& a = part.positions[part.faces[f][i]];
      const Vec3& b = part.positions[part.faces[f][(i + 1) % 3]];
      if (box.contains(a) && box.contains(b)) {
        EXPECT_LE((b - a).norm(), 0.05);
      }
      const Index g = part.neighbours[f][i];
      EXPECT_FALSE(g != kNone &&
                   part.boundary.contains({part.faces[f][i], part.faces[f][(i + 1) % 3]}));
      if (g == kNone) continue;
      EXPECT_EQ(std::ranges::count(part.neighbours[g], static_cast<Index>(f)), 1);
      EXPECT_EQ(std::ranges::count(part.faces[g], part.faces[f][i]), 1);
      EXPECT_EQ(std::ranges::count(part.faces[g], part.faces[f][(i + 1) % 3]), 1);
    }
  }
}

TEST(SurfacePart, KnowsTheBoundaryOfTheSurface) {
  const Case c = grid(8, 4, [](double, double) { return 0.0; });
  const Eigen::AlignedBox3d box(Vec3(0.01, 0.3, -1), Vec3(0.6, 0.7, 1));
  const SurfacePart part = surface_part(c.mesh, {40}, box, 0.05, 10000);
  double length = 0;
  for (const auto& [a, b] : part.boundary) {
    EXPECT_EQ(part.positions[a].x() + c.mesh.origin.x(), 0);
    EXPECT_EQ(part.positions[b].x() + c.mesh.origin.x(), 0);
    EXPECT_LE((part.positions[b] - part.positions[a]).norm(), 0.125);
    length += (part.positions[b] - part.positions[a]).norm();
  }
  EXPECT_NEAR(length, 0.5, 1e-12);  // four sides of squares, from 0.25 to 0.75
}

TEST(SurfacePart, IsEmptyWhereItWouldHaveTooManyFaces) {
  const Case c = grid(4, 4, terrain);
  const Eigen::AlignedBox3d box(Vec3(0, 0, -1), Vec3(1, 1, 1));
  EXPECT_TRUE(surface_part(c.mesh, {0}, box, 0.01, 1000).faces.empty());
  EXPECT_TRUE(surface_part(c.mesh, {0}, box, 10, 31).faces.empty());  // of 32, none divided
  EXPECT_EQ(surface_part(c.mesh, {0}, box, 10, 32).faces.size(), 32u);
}

/// Of a result of 8 x 8 cells.
std::set<Index> nine_cells(const InlayCutter& cutter) {
  std::set<Index> cells = {3 * 8 + 4};
  cutter.add_ring(cells);
  return cells;
}

TEST(InlayCutter, PutsTheInputOverCells) {
  const Case c = grid(32, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  const std::set<Index> cells = nine_cells(cutter);
  ASSERT_EQ(cells.size(), 9u);
  const std::optional<Inlay> inlay = cutter.cut(cells);
  ASSERT_TRUE(inlay.has_value());
  EXPECT_EQ(inlay->cells, std::vector<Index>(cells.begin(), cells.end()));
  EXPECT_EQ(inlay->outline.size(), 12u);
  // Of the input over the cells nothing is left out, but along the outline: it is as large, ...
  const std::vector<Vec3> positions = positions_of(*inlay, surfaces);
  double over = 0;
  double on_plane = 0;
  for (const auto& t : inlay->faces) on_plane += area_vector(positions, t).z();
  for (const auto& t : c.mesh.faces) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : t) middle += c.mesh.positions[v] / 3;
    const bool is_over =
        std::abs(middle.x() - 0.5625) < 0.1875 && std::abs(middle.y() - 0.4375) < 0.1875;
    if (is_over) over += area_vector(c.mesh.positions, t).norm();
  }
  EXPECT_NEAR(on_plane, 9.0 / 64, 1e-9);
  EXPECT_NEAR(area(positions, inlay->faces), over, 0.01 * over);
  // ... and each vertex of it inside is there.
  std::set<std::array<double, 2>> places;
  for (std::size_t i = inlay->outline.size(); i < positions.size(); ++i) {
    places.insert({positions[i].x(), positions[i].y()});
  }
  for (int i = 13; i < 24; ++i) {
    for (int j = 9; j < 20; ++j) {
      EXPECT_TRUE(places.contains({i / 32.0, j / 32.0})) << i << " " << j;
    }
  }
}

TEST(InlayCutter, CutsNoneOfTwoDisksOrOfAll) {
  const Case c = grid(32, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  EXPECT_FALSE(cutter.cut({3 * 8 + 3, 3 * 8 + 5}).has_value());
  std::set<Index> all;
  for (Index f = 0; f < 64; ++f) all.insert(f);
  EXPECT_FALSE(cutter.cut(all).has_value());  // no vertex of the result would stay
  std::set<Index> ring = {3 * 8 + 4};
  cutter.add_ring(ring);
  ring.erase(3 * 8 + 4);
  const std::optional<Inlay> inlay = cutter.cut(ring);
  ASSERT_TRUE(inlay.has_value());  // with what it encloses
  EXPECT_EQ(inlay->cells.size(), 9u);
}

/// Flat sheets, all but the last, each of cells x cells cells.
Case flat_sheets(std::size_t count, Index cells, const support::Height& last) {
  std::vector<support::Height> heights;
  for (std::size_t i = 0; i + 1 < count; ++i) {
    heights.emplace_back([i](double, double) { return 2.0 * static_cast<double>(i); });
  }
  heights.push_back(last);
  return support::sheets(8, cells, heights);
}

TEST(InlayCutter, CutsSmallComponentsAsAWhole) {
  const auto below = [](double x, double y) { return terrain(x, y) - 2; };
  const Case c = flat_sheets(3, 2, below);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  for (const std::size_t most : {3, 4}) {
    const InlayCutter cutter(surfaces, c.quads, most);
    const Index cells = c.quads.mesh.face_count();
    std::set<Index> last;
    for (Index f = cells - 4; f < cells; ++f) last.insert(f);
    const std::optional<Inlay> inlay = cutter.cut(last);
    ASSERT_EQ(inlay.has_value(), most == 4);
    if (!inlay) continue;
    EXPECT_EQ(inlay->cells, std::vector<Index>(last.begin(), last.end()));
    EXPECT_TRUE(inlay->outline.empty());
    EXPECT_EQ(inlay->faces.size(), 128u);
    EXPECT_EQ(inlay->points.size(), 81u);
    for (const SurfacePoint& point : inlay->points) {
      const Vec3 p = place_of(c.mesh, point) + c.mesh.origin;
      EXPECT_NEAR(p.z(), below(p.x(), p.y()), 1e-12);
    }
  }
}

TEST(Thinning, LeavesMoreInBalls) {
  const Case c = grid(64, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  const std::set<Index> cells = nine_cells(cutter);
  const std::optional<Inlay> inlay = cutter.cut(cells);
  ASSERT_TRUE(inlay.has_value());
  Thinning thinning(surfaces, SurfaceLines(c.mesh), *inlay);
  const std::vector<Vec3> positions = positions_of(*inlay, surfaces);
  const Ball ball{surfaces.positions()[4 * 9 + 5], 0.08};  // a corner of the cell in the middle
  const auto shares_left = [&] {                           // of vertices in the ball, and elsewhere
    const auto inside = static_cast<Index>(inlay->outline.size());
    std::set<Index> left;
    for (const auto& t : thinning.faces(0.01)) left.insert(t.begin(), t.end());
    std::array<double, 2> count = {0, 0};
    std::array<double, 2> kept = {0, 0};
    for (Index v = inside; v < std::ssize(positions); ++v) {
      const std::size_t where = (positions[v] - ball.middle).norm() <= ball.radius ? 0 : 1;
      ++count[where];
      if (left.contains(v)) ++kept[where];
    }
    return std::array{kept[0] / count[0], kept[1] / count[1]};
  };
  std::array<double, 2> before = shares_left();
  EXPECT_LT(before[0], 0.3);
  EXPECT_LT(before[1], 0.3);
  for (std::size_t level = 0; level < Thinning::kLevels; ++level) {
    EXPECT_TRUE(thinning.lessen({ball}, 1, 1));
    const std::array<double, 2> after = shares_left();
    EXPECT_GE(after[0], before[0]);
    EXPECT_LT(after[1], 0.4);
    before = after;
  }
  EXPECT_EQ(before[0], 1);
  EXPECT_FALSE(thinning.lessen({ball}, 1, 1));
  EXPECT_TRUE(thinning.lessen({ball}, 100, Thinning::kLevels));
  EXPECT_EQ(thinning.faces(0.01), inlay->faces);
}

/// The result with an inlay in it.
PolyMesh inlaid(const Case& c, const Inlay& inlay) {
  PolyMesh mesh;
  mesh.positions = c.quads.mesh.positions;
  for (Index f = 0; f < c.quads.mesh.face_count(); ++f) {
    if (!std::ranges::binary_search(inlay.cells, f)) mesh.add_face(c.quads.mesh.face(f));
  }
  const Index first = mesh.vertex_count();
  for (const SurfacePoint& p : inlay.points) {
    mesh.positions.push_back(place_of(c.mesh, p) + c.mesh.origin);
  }
  const auto outline = static_cast<Index>(inlay.outline.size());
  for (std::array<Index, 3> t : inlay.faces) {
    for (Index& v : t) v = v < outline ? inlay.outline[v] : first + v - outline;
    mesh.add_face(t);
  }
  return mesh;
}

double flat_area(const PolyMesh& mesh) {
  double sum = 0;
  for (const auto& t : triangulate_faces(mesh).corners) sum += area_vector(mesh.positions, t).z();
  return sum;
}

/// A case of n x n cells without some of them, and without the surface under some.
Case with_holes(const Case& whole, Index n, const std::set<Index>& cells,
                const std::set<Index>& surface) {
  const auto index = [&](double x) { return std::min<Index>(n - 1, static_cast<Index>(n * x)); };
  const auto cell_at = [&](const Vec3& p) { return n * index(p.y()) + index(p.x()); };
  PolyMesh soup;
  std::map<Index, Index> number;
  for (const auto& t : whole.mesh.faces) {
    Vec3 middle = whole.mesh.origin;
    for (const Index v : t) middle += whole.mesh.positions[v] / 3;
    if (surface.contains(cell_at(middle))) continue;
    std::array<Index, 3> face = t;
    for (Index& v : face) {
      const auto [at, is_new] = number.try_emplace(v, soup.vertex_count());
      if (is_new) soup.positions.push_back(whole.mesh.positions[v] + whole.mesh.origin);
      v = at->second;
    }
    soup.add_face(face);
  }
  Case result;
  result.mesh = support::plain_tri_mesh(soup);
  result.quads.mesh.positions = whole.quads.mesh.positions;
  for (Index f = 0; f < whole.quads.mesh.face_count(); ++f) {
    if (!cells.contains(f)) result.quads.mesh.add_face(whole.quads.mesh.face(f));
  }
  for (const Vec3& p : whole.quads.mesh.positions) {
    const auto at = std::ranges::find(soup.positions, p);
    const auto v = static_cast<std::size_t>(at - soup.positions.begin());
    const Index h = at == soup.positions.end() ? 0 : result.mesh.vertex_out[v];
    std::array<double, 3> barycentric = {0, 0, 0};
    barycentric[h % 3] = 1;
    result.quads.provenance.face.push_back(TriMesh::face_of(h));
    result.quads.provenance.barycentric.push_back(barycentric);
    result.quads.provenance.lines.push_back({kNone, kNone});
  }
  return result;
}

/// A case of 8 x 8 cells without those that are named, and without the surface under them.
Case with_hole(const Case& whole, const std::set<Index>& cells) {
  return with_holes(whole, 8, cells, cells);
}

/// Puts an inlay over cells into a result. \pre the surface is not much bent
void expect_inlay(const Case& c, const std::set<Index>& cells, Index euler, Index boundaries) {
  SCOPED_TRACE(testing::PrintToString(cells));
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const std::optional<Inlay> inlay = InlayCutter(surfaces, c.quads).cut(cells);
  ASSERT_TRUE(inlay.has_value());
  EXPECT_GT(inlay->points.size(), 4 * cells.size());
  const PolyMesh mesh = inlaid(c, *inlay);
  const PolyTopology topology = analyse(mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, euler);
  EXPECT_EQ(topology.boundary_loops, boundaries);
  EXPECT_NEAR(flat_area(mesh), flat_area(c.quads.mesh), 1e-9);
}

TEST(InlayCutter, GoesAlongTheBoundary) {
  const Case c = grid(32, 8, terrain);
  expect_inlay(c, {0, 1, 8, 9}, 1, 1);           // a corner
  expect_inlay(c, {3, 4, 5, 11, 12, 13}, 1, 1);  // one side
  std::set<Index> across;
  for (Index f = 24; f < 40; ++f) across.insert(f);  // from one side to the other
  expect_inlay(c, across, 1, 1);
}

TEST(InlayCutter, GoesAroundHoles) {
  const Case c = with_hole(grid(32, 8, terrain), {27, 28});
  std::set<Index> beside = {18, 19, 20, 26};  // part of the hole's boundary
  expect_inlay(c, beside, 0, 2);
  std::set<Index> around;  // all of it
  for (Index y = 2; y < 5; ++y) {
    for (Index x = 2; x < 6; ++x) {
      const Index cell = 8 * y + x;
      if (cell < 27 || cell > 28) around.insert(cell < 27 ? cell : cell - 2);
    }
  }
  expect_inlay(c, around, 0, 2);
}

TEST(InlayCutter, GoesInRings) {
  // Around more cells than it has, which are none of its own.
  const Case c = grid(32, 8, terrain);
  std::set<Index> ring;
  for (Index i = 0; i < 8; ++i) ring.insert({i, 56 + i, 8 * i, 8 * i + 7});
  expect_inlay(c, ring, 1, 1);
}

/// A result with inlays where it was beyond a tolerance, which it is not any more.
QuadMesh mended(const Case& c, double tolerance) {
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), tolerance);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  EXPECT_FALSE(excess.empty());
  EXPECT_TRUE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), tolerance).empty());
  return quads;
}

TEST(Inlays, BringWhatIsBeyondWithinTheTolerance) {
  const Case c = needle();
  const QuadMesh quads = mended(c, 0.004);
  const PolyTopology topology = analyse(quads.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, 1);
  EXPECT_LT(quads.mesh.vertex_count(), c.mesh.vertex_count());
  for (Index v = 0; v < quads.mesh.vertex_count(); ++v) {
    const Vec3 foot = place_of(c.mesh, {quads.provenance.face[v], quads.provenance.barycentric[v]});
    EXPECT_LT((foot - quads.mesh.positions[v]).norm(), 1e-12);
  }
}

TEST(Inlays, AreNotThinnedOutThroughWhatIsNear) {
  // A valley with a pit, and a sheet closely above it: longer edges than those of cells would cut
  // across the valley through that sheet.
  const auto valley = [](double x) { return 0.5 * (x - 0.5) * (x - 0.5); };
  const auto below = [&](double x, double y) {
    return valley(x) - (std::hypot(x - 0.46875, y - 0.46875) < 0.005 ? 0.1 : 0.0);
  };
  const auto above = [&](double x, double) { return valley(x) + 0.0003; };
  const Case c = sheets(64, 16, {below, above});
  constexpr double kTolerance = 0.01;
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), kTolerance);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  ASSERT_FALSE(excess.empty());
  ASSERT_TRUE(crossing.faces_of(quads.mesh).empty());
  ASSERT_TRUE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), kTolerance).empty());
}

/// One round of dividing does not reach a needle.
TEST(Inlays, DoWhatDividingLeaves) {
  const Case c = needle();
  RefineOptions options;
  options.tolerance = Length{0.004, false};
  options.rounds = 1;
  SilentObserver observer;
  const RefineResult result = refine_cells(c.mesh, c.quads, options, observer);
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result.quads), 0.004).empty());
  const auto& entries = result.report.entries();
  const auto beyond = std::ranges::find(entries, "refine.places_beyond",
                                        [](const auto& entry) { return entry.first; });
  ASSERT_NE(beyond, entries.end());
  EXPECT_EQ(std::get<std::int64_t>(beyond->second), 0);
}

TEST(Inlays, LeaveAResultThatTheyCannotMend) {
  const Case c = grid(32, 1, [](double x, double) { return x * (1 - x); });  // one cell is all
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.01);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  ASSERT_FALSE(excess.empty());
  EXPECT_FALSE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

/// No more than a tenth of the result.
TEST(Inlays, MendComponentsThatHaveNothingAround) {
  const Case c = flat_sheets(10, 1, [](double x, double) { return x * (1 - x) - 2; });
  const QuadMesh quads = mended(c, 0.02);
  EXPECT_LT(quads.mesh.face_count(), 9 + 128);  // thinned out
  const PolyTopology topology = analyse(quads.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
  EXPECT_EQ(topology.components, 10);
  EXPECT_EQ(topology.boundary_loops, 10);
}

/// Over a flat with small waves a vertex in the middle of n x n cells lies beyond its neighbours;
/// the outline of the cells around it crosses itself, so that the vertex cannot just be taken out.
Case crossed(Index n = 8) {
  Case c = grid(4 * n, n, [](double x, double y) { return 0.2 * terrain(x, y); });
  const Index middle = (n + 2) * (n / 2);
  std::swap(c.quads.provenance.face[middle], c.quads.provenance.face[middle + 1]);
  std::swap(c.quads.provenance.barycentric[middle], c.quads.provenance.barycentric[middle + 1]);
  std::swap(c.quads.mesh.positions[middle], c.quads.mesh.positions[middle + 1]);
  return c;
}

TEST(Inlays, MakeFacesThatCrossFewer) {
  const Case c = crossed();
  CrossingPlaces crossing(c.mesh);
  ASSERT_FALSE(crossing.faces_of(c.quads.mesh).empty());
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.02);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  const std::vector<char> is_of_inlay = inlay_crossing(proof, crossing, 0.02, quads);
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), 0.02).empty());
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, 1);
  ASSERT_EQ(is_of_inlay.size(), quads.mesh.positions.size());
  EXPECT_GT(std::ranges::count(is_of_inlay, 1), 4);
  // What is of none is of the result.
  for (std::size_t v = 0; v < is_of_inlay.size(); ++v) {
    if (is_of_inlay[v] != 0) continue;
    EXPECT_EQ(std::ranges::count(c.quads.mesh.positions, quads.mesh.positions[v]), 1);
  }
}

/// An inlay of the input's own faces has more vertices than the cells that it takes the place of; a
/// result for a count has no room for them.
TEST(Inlays, AddFewVerticesWhereFacesCross) {
  const Case c = crossed(24);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.02);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  CrossingPlaces crossing(c.mesh);
  inlay_crossing(proof, crossing, 1e-6, quads);
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_LE(quads.mesh.vertex_count(), 1.03 * c.quads.mesh.vertex_count());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), 0.02).empty());
}

/// The surface has a hole where faces of the result cross, which has one far away instead: only
/// what lies over hundreds of cells is like them.
TEST(Inlays, StayInProportionToWhatCrosses) {
  constexpr Index kCells = 40;
  const Index middle = (kCells + 1) * (kCells / 2);
  const Case c = with_holes(crossed(kCells), kCells, {middle + 8 * kCells}, {middle});
  CrossingPlaces crossing(c.mesh);
  ASSERT_FALSE(crossing.faces_of(c.quads.mesh).empty());
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.03);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  EXPECT_TRUE(inlay_crossing(proof, crossing, 0.03, quads).empty());
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

/// Without a tolerance, and where other places are far from the surface.
TEST(Uncross, ReplacesOnlyWhatCrosses) {
  Case c = crossed();
  c.quads.mesh.positions[9 + 1].z() += 0.1;
  SilentObserver observer;
  CrossingPlaces crossing(c.mesh);
  const std::size_t before = crossing.faces_of(c.quads.mesh).size();
  ASSERT_GT(before, 0u);
  const UncrossResult result = uncross_faces(c.mesh, c.quads, observer);
  const PolyMesh& mesh = result.quads.mesh;
  EXPECT_EQ(crossing.faces_of(mesh).size(), 0u);
  const auto& entries = result.report.entries();
  const auto uncrossed = std::ranges::find(entries, "refine.uncrossed_faces",
                                           [](const auto& entry) { return entry.first; });
  ASSERT_NE(uncrossed, entries.end());
  EXPECT_EQ(std::get<std::int64_t>(uncrossed->second), static_cast<std::int64_t>(before));
  EXPECT_TRUE(analyse(mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(mesh).euler, 1);
  // Cells around the lifted vertex stay, though nothing else is so far from the surface.
  const Vec3& lifted = c.quads.mesh.positions[9 + 1];
  EXPECT_EQ(std::ranges::count(mesh.positions, lifted), 1);
  // What is new is thinned out, paired, and no farther than the farthest place was.
  EXPECT_LT(mesh.vertex_count(), 81 + 24);
  Index new_quads = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const bool is_new = std::ranges::any_of(mesh.face(f), [&](Index v) {
      return std::ranges::count(c.quads.mesh.positions, mesh.positions[v]) == 0;
    });
    new_quads += is_new && mesh.face(f).size() == 4 ? 1 : 0;
  }
  EXPECT_GT(new_quads, 0);
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result.quads), 0.11).empty());
}

TEST(Uncross, LeavesWhatDoesNotCross) {
  const Case c = grid(32, 8, terrain);
  SilentObserver observer;
  const QuadMesh quads = uncross_faces(c.mesh, c.quads, observer).quads;
  EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

}  // namespace
}  // namespace strake
