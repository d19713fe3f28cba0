#include "stages/refine/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "common/core/error.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "stages/refine/surface_points.h"
#include "tests/support/chain.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::bent_strip;
using support::Case;
using support::grid;
using support::sides;
using support::toothed_sheet;
using support::total_area;

RefineOptions within(double tolerance) {
  RefineOptions options;
  options.tolerance = Length{tolerance, false};
  return options;
}

QuadMesh refined(const Case& c, const RefineOptions& options) {
  SilentObserver observer;
  return refine_cells(c.mesh, c.quads, options, observer).quads;
}

TEST(Refine, CutsAcrossTheDirectionThatBends) {
  const double k = 0.3;
  const QuadMesh result = refined(bent_strip(k), within(1.05 * k / 8 / 16));
  EXPECT_EQ(result.mesh.face_count(), 4);
  EXPECT_EQ(result.mesh.vertex_count(), 10);
  EXPECT_EQ(sides(result.mesh).count(4), 4U);
}

TEST(Refine, KeepsTheToleranceOnTerrain) {
  const Case c = grid(32, 4, [](double x, double y) {
    return 0.05 * std::sin(9 * x) * std::cos(7 * y) +
           0.03 * std::exp(-200 * ((x - 0.4) * (x - 0.4) + (y - 0.6) * (y - 0.6)));
  });
  for (const double tolerance : {0.01, 0.002}) {
    const QuadMesh result = refined(c, within(tolerance));
    EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), tolerance).empty());
    EXPECT_TRUE(analyse(result.mesh).is_oriented_manifold());
    EXPECT_EQ(analyse(result.mesh).euler, 1);  // still a disk
    EXPECT_LE(*sides(result.mesh).rbegin(), 5U);
  }
}

/// A grid with two cells as a triangle and a pentagon, between which lies a ridge, and its
/// triangles as the surface.
/// \param shift  of the pentagon's corner beyond the ridge, away from it
Case odd_pair(double shift) {
  const Case c = grid(4, 4, [](double, double) { return 0.0; });
  PolyMesh cut;
  cut.positions = c.quads.mesh.positions;
  for (Index f = 0; f < c.quads.mesh.face_count(); ++f) {
    if (f != 5 && f != 6) cut.add_face(c.quads.mesh.face(f));
  }
  cut.add_face(std::array<Index, 3>{6, 7, 11});
  cut.add_face(std::array<Index, 5>{7, 8, 13, 12, 11});
  cut.positions[7].z() = 0.05;
  cut.positions[11].z() = 0.05;
  cut.positions[12] += shift * Vec3(1, 1, 0);
  return support::on_triangles(cut, triangulate_faces(cut));
}

/// The quad on the ridge is cut along its shorter diagonal: along the ridge or across it.
TEST(Refine, PairsOddCellsWhereTheToleranceAllowsIt) {
  for (const auto& [shift, quads] : {std::pair{0.03, 16U}, {-0.03, 14U}}) {
    const Case c = odd_pair(shift);
    const QuadMesh result = refined(c, within(0.005));
    EXPECT_EQ(sides(result.mesh).count(4), quads);
    EXPECT_EQ(result.mesh.vertex_count(), 25);
    EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), 0.005).empty());
  }
  EXPECT_EQ(sides(refined(odd_pair(-0.03), within(0.06)).mesh).count(4), 16U);
}

TEST(Refine, PairsOddCellsForACountWhereTheyComeNoFartherOff) {
  RefineOptions options;
  options.vertices = 25;  // those that are there
  EXPECT_EQ(sides(refined(odd_pair(0.03), options).mesh).count(4), 16U);
  EXPECT_EQ(sides(refined(odd_pair(-0.03), options).mesh).count(4), 14U);
  options.vertices.reset();
  EXPECT_EQ(sides(refined(odd_pair(0.03), options).mesh).count(4), 14U);
}

TEST(Refine, CutsCellsThatOthersWouldCutBeyondTheTolerance) {
  const PolyMesh pentagon = support::undecided_pentagon();
  const Case c = support::on_triangles(pentagon, triangulate_faces(pentagon));
  const auto cells_in_doubt = [&](const QuadMesh& quads) {
    const ComparedSurfaces surfaces(c.mesh, quads);
    return ToleranceProof(surfaces.shared_input(), 0.1).cells_in_doubt(surfaces);
  };
  ASSERT_EQ(cells_in_doubt(c.quads), std::vector<Index>{0});
  const QuadMesh result = refined(c, within(0.1));
  EXPECT_EQ(sides(result.mesh), (std::multiset<std::size_t>{3, 3, 3}));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), 0.1).empty());
  EXPECT_TRUE(cells_in_doubt(result).empty());
  EXPECT_EQ(sides(refined(c, within(0.7)).mesh), (std::multiset<std::size_t>{5}));
}

/// One face between an arc over y = 0 and a straight side of this length at y = 1, on a surface of
/// narrow triangles.
Case arc_and_short_side(double side) {
  constexpr Index kPieces = 64;
  PolyMesh soup;
  for (Index i = 0; i <= kPieces; ++i) {
    const double u = double(i) / kPieces;
    soup.positions.emplace_back(u, 0, u * (1 - u) / 2);
    soup.positions.emplace_back(0.5 + side * (u - 0.5), 1, 0);
  }
  for (Index i = 0; i < 2 * kPieces; i += 2) {
    soup.add_face(std::array<Index, 3>{i, i + 2, i + 3});
    soup.add_face(std::array<Index, 3>{i, i + 3, i + 1});
  }
  Case c;
  c.mesh = support::plain_tri_mesh(soup);
  constexpr Index kEnd = 2 * kPieces;
  for (const auto& [v, face, corner] :
       {std::array<Index, 3>{0, 0, 0}, {kEnd, kEnd - 2, 1}, {kEnd + 1, kEnd - 2, 2}, {1, 1, 2}}) {
    c.mesh.is_corner[v] = 1;
    c.quads.mesh.positions.emplace_back(soup.positions[v]);
    c.quads.provenance.face.push_back(face);
    c.quads.provenance.barycentric.push_back({0, 0, 0});
    c.quads.provenance.barycentric.back()[corner] = 1;
    c.quads.provenance.lines.push_back({kNone, kNone});
  }
  c.quads.mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  return c;
}

/// The side opposite the arc would be halved in each round.
TEST(Refine, DoesNotDivideAShortSideWithTheOneOpposite) {
  constexpr double kSide = 0.02;
  const Case c = arc_and_short_side(kSide);
  const QuadMesh result = refined(c, within(3e-3));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), 3e-3).empty());
  EXPECT_TRUE(analyse(result.mesh).is_oriented_manifold());
  const PolyEdges edges = collect_edges(result.mesh);
  double shortest = 1;
  double sum = 0;
  for (const auto& [a, b] : edges.vertices) {
    const double length = (result.mesh.positions[b] - result.mesh.positions[a]).norm();
    shortest = std::min(shortest, length);
    sum += length;
  }
  EXPECT_GT(edges.edge_count(), 16);
  EXPECT_GE(shortest, 0.9 * kSide);
  EXPECT_GT(shortest * edges.edge_count() / sum, 0.01);
}

TEST(Refine, LeavesWhatIsWithinTheTolerance) {
  const Case c = bent_strip(0.1);
  const QuadMesh result = refined(c, within(0.1));
  EXPECT_EQ(result.mesh.corners, c.quads.mesh.corners);
  EXPECT_EQ(result.mesh.vertex_count(), c.quads.mesh.vertex_count());
}

/// Vertices may have been moved off the surface; those that are too far off come back.
TEST(Refine, PutsVerticesBackOntoTheSurface) {
  Case c = grid(8, 4, [](double, double) { return 0.0; });
  c.quads.mesh.positions[12] += Vec3(0, 0, 0.1);  // in the middle
  const QuadMesh result = refined(c, within(0.01));
  EXPECT_NEAR(result.mesh.positions[12].z(), 0, 1e-12);
  EXPECT_EQ(result.mesh.face_count(), 16);
}

TEST(Refine, SaysWhereTheToleranceIsNotReached) {
  RefineOptions options = within(1e-3);
  options.rounds = 0;
  try {
    refined(bent_strip(0.3), options);
    ADD_FAILURE() << "no error";
  } catch (const ToleranceError& error) {
    EXPECT_EQ(error.code(), ExitCode::tolerance_missed);
    EXPECT_NE(std::string(error.what()).find(" at (0.5"), std::string::npos) << error.what();
  }
  options.partly = true;
  EXPECT_EQ(refined(bent_strip(0.3), options).mesh.face_count(), 1);
}

/// A result for one of two plates only, which are 0.5 apart: no division of its cells reaches the
/// other one.
Case one_of_two_plates(Index cells) {
  Case c = grid(2 * cells, cells, [](double, double) { return 0.0; });
  PolyMesh soup;
  for (const double z : {0.0, 0.5}) {
    const Index first = soup.vertex_count();
    for (const Vec3& p : c.mesh.positions) soup.positions.emplace_back(p + Vec3(0, 0, z));
    for (const auto& [u, v, w] : c.mesh.faces) {
      soup.add_face(std::array<Index, 3>{first + u, first + v, first + w});
    }
  }
  c.mesh = support::plain_tri_mesh(soup);
  return c;
}

TEST(Refine, GivesUpWhereDividingIsInVain) {
  const Case c = one_of_two_plates(2);
  try {
    refined(c, within(0.01));
    ADD_FAILURE() << "no error";
  } catch (const ToleranceError& error) {
    EXPECT_NE(std::string(error.what()).find("after 4 rounds"), std::string::npos) << error.what();
    EXPECT_FALSE(error.places().empty());
    for (const Vec3& p : error.places()) EXPECT_NEAR(p.z(), 0.5, 1e-12);
  }
}

/// Cells with diagonals of up to 1.5 tolerances are not divided for what is farther away.
TEST(Refine, LeavesCellsThatAreSmallAgainstTheTolerance) {
  const Case c = one_of_two_plates(8);
  const double diagonal = std::sqrt(2) / 8;
  for (const double tolerances : {1.4, 1.6}) {
    RefineOptions options = within(diagonal / tolerances);
    options.partly = true;
    EXPECT_EQ(refined(c, options).mesh.face_count() > 64, tolerances > 1.5) << tolerances;
  }
}

TEST(Refine, SpendsACountOnTheWorstCells) {
  const Case c =
      grid(64, 8, [](double x, double) { return x < 0.5 ? 0.0 : std::sin(12 * (x - 0.5)) / 10; });
  RefineOptions options;
  options.vertices = 100;
  const QuadMesh result = refined(c, options);
  EXPECT_NEAR(result.mesh.vertex_count(), 100, 5);
  for (Index v = 81; v < result.mesh.vertex_count(); ++v) {
    EXPECT_GT(result.mesh.positions[v].x(), 0.49) << "the flat half needs nothing";
  }
}

/// Two arched sheets, one just above the other and a little flatter, with a flat face for each:
/// that of the lower one is farther off, and half of it would stick through that of the upper one.
Case arched_sheets(double gap) {
  Case result;
  PolyMesh soup;
  for (const auto& [k, z] : {std::pair{0.31, 0.0}, std::pair{0.30, gap}}) {
    const Case sheet = bent_strip(k);
    const Index vertices = soup.vertex_count();
    const Index faces = soup.face_count();
    const Index corners = result.quads.mesh.vertex_count();
    for (const Vec3& p : sheet.mesh.positions) soup.positions.emplace_back(p + Vec3(0, 0, z));
    for (const auto& [a, b, c] : sheet.mesh.faces) {
      soup.add_face(std::array<Index, 3>{vertices + a, vertices + b, vertices + c});
    }
    QuadMesh& quads = result.quads;
    for (Index v = 0; v < sheet.quads.mesh.vertex_count(); ++v) {
      quads.mesh.positions.emplace_back(sheet.quads.mesh.positions[v] + Vec3(0, 0, z));
      quads.provenance.face.push_back(faces + sheet.quads.provenance.face[v]);
      quads.provenance.barycentric.push_back(sheet.quads.provenance.barycentric[v]);
      quads.provenance.lines.push_back({kNone, kNone});
    }
    std::vector<Index> face(sheet.quads.mesh.face(0).begin(), sheet.quads.mesh.face(0).end());
    for (Index& v : face) v += corners;
    quads.mesh.add_face(face);
  }
  result.mesh = support::plain_tri_mesh(soup);
  return result;
}

TEST(Refine, DoesNotMakeFacesCrossForACount) {
  const Case c = arched_sheets(0.01);
  for (const std::int64_t vertices : {10, 12}) {
    RefineOptions options;
    options.vertices = vertices;
    const PolyMesh result = refined(c, options).mesh;
    EXPECT_EQ(result.vertex_count(), vertices) << "another cell is divided instead";
    EXPECT_TRUE(find_crossing_faces(result.positions, triangulate_faces(result)).empty())
        << vertices;
  }
}

TEST(Refine, IsTheSameForAnyNumberOfThreads) {
  const Case c = grid(32, 4, [](double x, double y) { return 0.1 * std::sin(9 * x + 5 * y * y); });
  const QuadMesh many = refined(c, within(0.002));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const QuadMesh single = refined(c, within(0.002));
  EXPECT_EQ(many.mesh.corners, single.mesh.corners);
  EXPECT_EQ(many.mesh.positions, single.mesh.positions);
}

/// Teeth of the boundary, higher than the tolerance, take a vertex each at their tips and at the
/// valleys between, and nothing else changes.
TEST(Refine, DividesOnlyAtAJaggedBoundary) {
  const Index teeth = 64;
  const Index cells = 4;
  Case c = toothed_sheet(teeth, cells, 0.03);
  std::ranges::fill(c.mesh.is_corner, 1);
  const QuadMesh result = refined(c, within(0.004));
  const Index valleys = teeth - cells;  // but for those at the corners of cells
  EXPECT_EQ(result.mesh.vertex_count(), c.quads.mesh.vertex_count() + teeth + valleys);
  Index inside = 0;
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    const auto face = result.mesh.face(f);
    const bool is_inside = std::ranges::all_of(
        face, [&](Index v) { return result.mesh.positions[v].y() < 1 - 0.9 / cells; });
    inside += is_inside && face.size() == 4 ? 1 : 0;
  }
  EXPECT_EQ(inside, cells * (cells - 1));
}

/// What lies across a notch, turned over, is no part of the surface: it goes, and no vertex is put
/// where the boundary has one.
TEST(Refine, DropsCellsAcrossNotches) {
  Case c = toothed_sheet(8, 1, 0.1);
  std::ranges::fill(c.mesh.is_corner, 1);
  // The cell reaches to the tips of the outermost teeth; another one lies across the notches
  // between, with a vertex in the middle one.
  const auto add = [&](const SurfacePoint& point) {
    c.quads.mesh.positions.push_back(place_of(c.mesh, point) + c.mesh.origin);
    c.quads.provenance.face.push_back(point.face);
    c.quads.provenance.barycentric.push_back(point.barycentric);
    c.quads.provenance.lines.push_back({kNone, kNone});
    return c.quads.mesh.vertex_count() - 1;
  };
  const Index first_tooth = 2 * 8 * 8;
  const Index right = add({first_tooth + 7, {0, 1, 0}});
  const Index left = add({first_tooth, {0, 1, 0}});
  const Index valley = add({first_tooth + 3, {1, 0, 0}});
  c.quads.mesh.corners.clear();
  c.quads.mesh.offsets = {0};
  c.quads.mesh.add_face(std::array<Index, 6>{0, 1, 3, right, left, 2});
  c.quads.mesh.add_face(std::array<Index, 3>{left, right, valley});
  const QuadMesh result = refined(c, within(0.02));
  EXPECT_EQ(result.mesh.vertex_count(), 4 + 8 + 7);
  const auto& p = result.mesh.positions;
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    for (Index w = 0; w < v; ++w) EXPECT_GT((p[v] - p[w]).norm(), 0.01);
  }
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    EXPECT_GT(newell_normal(p, result.mesh.face(f)).z(), 1e-3);
  }
}

/// A cell may lie along any number of teeth.
TEST(Refine, ReachesAllTeethAlongACell) {
  Case c = toothed_sheet(64, 2, 0.016);
  std::ranges::fill(c.mesh.is_corner, 1);
  const QuadMesh result = refined(c, within(0.004));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), 0.004).empty());
}

TEST(RefineCells, UnfoldsFacesThatCrossWithinTheTolerance) {
  Case c = grid(8, 8, [](double, double) { return 0.0; });
  c.quads.mesh.positions[4 * 9 + 4] = Vec3(0.7, 0.54, 0);
  const auto crossings = [](const PolyMesh& mesh) {
    return find_crossing_faces(mesh.positions, triangulate_faces(mesh)).size();
  };
  ASSERT_GT(crossings(c.quads.mesh), 0u);
  const QuadMesh result = refined(c, within(0.01));
  EXPECT_EQ(crossings(result.mesh), 0u);
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), 0.01).empty());
  EXPECT_NEAR(total_area(result.mesh), 1, 1e-12);
}

/// A blade whose rim is thinner than cells may be off, and jagged: cells go around it.
Case jagged_blade() {
  Case c = grid(32, 8, [](double, double) { return 0.0; });
  const auto place = [](const Vec3& p) {
    const double angle = std::numbers::pi * (p.x() - 0.5);
    const double reach = 1 + 0.04 * std::sin(40 * p.y());
    return Vec3(reach * std::cos(angle), p.y(), 0.01 * std::sin(angle));
  };
  PolyMesh soup;
  for (const Vec3& p : c.mesh.positions) soup.positions.push_back(place(p + c.mesh.origin));
  for (const auto& face : c.mesh.faces) soup.add_face(face);
  c.mesh = support::plain_tri_mesh(soup);
  for (Vec3& p : c.quads.mesh.positions) p = place(p);
  return c;
}

TEST(RefineCells, LeavesNothingCrossedAtAThinJaggedRim) {
  const Case c = jagged_blade();
  constexpr double kTolerance = 0.004;
  const QuadMesh result = refined(c, within(kTolerance));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result), kTolerance).empty());
  EXPECT_TRUE(find_crossing_faces(result.mesh.positions, triangulate_faces(result.mesh)).empty());
  EXPECT_LT(result.mesh.vertex_count(), c.mesh.vertex_count());
}

}  // namespace
}  // namespace strake
