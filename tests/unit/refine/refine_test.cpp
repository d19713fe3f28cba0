#include "stages/refine/refine.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "common/core/error.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "stages/refine/section_path.h"
#include "stages/refine/split_cells.h"
#include "stages/refine/surface_points.h"
#include "stages/refine/way_split.h"
#include "tests/support/chain.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::bent_strip;
using support::Case;
using support::grid;
using support::toothed_sheet;

RefineOptions within(double tolerance) {
  RefineOptions options;
  options.tolerance = Length{tolerance, false};
  return options;
}

QuadMesh refined(const Case& c, const RefineOptions& options) {
  SilentObserver observer;
  return refine_cells(c.mesh, c.quads, options, observer).quads;
}

std::multiset<std::size_t> sides(const PolyMesh& mesh) {
  std::multiset<std::size_t> result;
  for (Index f = 0; f < mesh.face_count(); ++f) result.insert(mesh.face(f).size());
  return result;
}

/// Where a vertex of the result lies on the surface.
SurfacePoint foot(const Case& c, Index v) {
  return {c.quads.provenance.face[v], c.quads.provenance.barycentric[v]};
}

/// A grid of unit squares as faces, flat.
PolyMesh squares(Index n) {
  return grid(n, n, [](double, double) { return 0.0; }).quads.mesh;
}

/// Splits with marks in the middle of straight edges.
PolyMesh split(PolyMesh mesh, const std::vector<std::array<Index, 2>>& edges,
               std::vector<Index> chosen) {
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  for (const auto& [a, b] : edges) {
    marks.set(a, b, static_cast<Index>(positions.size()));
    positions.push_back((positions[a] + positions[b]) / 2);
  }
  std::vector<char> divide(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Index f : chosen) divide[f] = 1;
  return split_cells(mesh, divide, marks, 5, positions,
                     [&](Index a, Index b, const std::vector<Index>&) {
                       positions.push_back((positions[a] + positions[b]) / 2);
                       return static_cast<Index>(positions.size()) - 1;
                     });
}

double total_area(const PolyMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    sum += newell_normal(mesh.positions, mesh.face(f)).z() / 2;
  }
  return sum;
}

// Vertices of squares(3): 0..3 in the first row, 4..7 in the second, and so on; face 4 is the
// middle one with the corners 5, 6, 10, 9.

TEST(SplitCells, OppositeMarksMakeTwoQuadsAndGiveTheNeighboursACorner) {
  const PolyMesh result = split(squares(3), {{5, 6}, {9, 10}}, {4});
  EXPECT_EQ(sides(result), (std::multiset<std::size_t>{4, 4, 4, 4, 4, 4, 4, 4, 5, 5}));
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
  EXPECT_NEAR(total_area(result), 1, 1e-12);
}

TEST(SplitCells, FourMarksMakeFourQuads) {
  const PolyMesh result = split(squares(3), {{5, 6}, {9, 10}, {5, 9}, {6, 10}}, {4});
  EXPECT_EQ(sides(result).count(4), 8U);
  EXPECT_EQ(sides(result).count(5), 4U);
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
}

TEST(SplitCells, MarksSideBySideMakeThreeQuads) {
  const PolyMesh result = split(squares(3), {{5, 6}, {6, 10}}, {4});
  EXPECT_EQ(sides(result).count(4), 9U);
  EXPECT_EQ(sides(result).count(5), 2U);
}

/// Cells at a boundary with teeth keep inside it, whichever way they are divided.
TEST(SplitCells, ChainsOfTeethMakeFacesInsideThem) {
  const PolyMesh mesh = squares(1);
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  std::vector<Index> chain;  // on the upper side, from right to left
  const Index teeth = 5;
  for (Index i = 1; i < 2 * teeth; ++i) {
    chain.push_back(static_cast<Index>(positions.size()));
    positions.emplace_back(1 - i / (2.0 * teeth), i % 2 == 0 ? 1.0 : 0.7, 0.0);
  }
  marks.set_chain(3, 2, chain);
  EXPECT_EQ(marks.at(3, 2), kNone);
  const PolyMesh result =
      split_cells(mesh, {0}, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  EXPECT_TRUE(analyse(result).is_oriented_manifold());
  EXPECT_EQ(result.vertex_count(), 4 + 2 * teeth - 1);
  // As all faces are turned up, none goes beyond the outline: five notches of height 0.3.
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_GT(newell_normal(result.positions, result.face(f)).z(), 0);
    EXPECT_LE(result.face(f).size(), 4U);
    EXPECT_FALSE(is_concave_face(result.positions, result.face(f)));
  }
  EXPECT_NEAR(total_area(result), 1 - 0.3 / 2, 1e-12);
}

/// The pentagon where a line ends: going on to the opposite edge leaves two quads.
TEST(SplitCells, ALineThatEndsInAPentagonGoesOn) {
  const PolyMesh first = split(squares(3), {{5, 6}, {9, 10}}, {4});  // 7 is a pentagon now
  Index pentagon = 0;
  for (Index f = 0; f < first.face_count(); ++f) {
    if (first.face(f).size() == 5 && newell_normal(first.positions, first.face(f)).z() > 0 &&
        first.positions[first.face(f)[0]].y() >= 2.0 / 3 - 1e-9) {
      pentagon = f;
    }
  }
  const PolyMesh second = split(first, {{13, 14}}, {pentagon});
  EXPECT_EQ(sides(second).count(5), 1U);
  EXPECT_EQ(sides(second).count(4), 10U);
}

TEST(SplitCells, ConcaveNeighboursAreDivided) {
  PolyMesh mesh = squares(3);
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  marks.set(5, 6, static_cast<Index>(positions.size()));
  positions.push_back((positions[5] + positions[6]) / 2 + Vec3(0, -0.1, 0));  // into face 1
  marks.set(9, 10, static_cast<Index>(positions.size()));
  positions.push_back((positions[9] + positions[10]) / 2 + Vec3(0, 0.1, 0));  // into face 7
  std::vector<char> divide(9, 0);
  divide[4] = 1;
  const PolyMesh result =
      split_cells(mesh, divide, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_FALSE(is_concave_face(result.positions, result.face(f))) << f;
  }
  EXPECT_NEAR(total_area(result), 1, 1e-12);
}

/// Two faces with two edges in common may both want the diagonal over these edges: only one gets
/// it.
TEST(SplitCells, NoDiagonalIsMadeTwice) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, -1.2, -1.2}, {2, 0, 0}, {1, 1, 0}, {1, 0, 1}};
  mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  mesh.add_face(std::array<Index, 4>{0, 4, 2, 1});
  std::vector<Vec3> positions = mesh.positions;
  EdgeMarks marks;
  for (const Index v : {3, 4}) {
    marks.set(2, v, static_cast<Index>(positions.size()));
    positions.push_back(v == 3 ? Vec3(1.95, 0.95, 0) : Vec3(1.95, 0, 0.95));
  }
  const PolyMesh result =
      split_cells(mesh, {1, 1}, marks, 5, positions,
                  [](Index, Index, const std::vector<Index>&) { return kNone; });
  EXPECT_GT(result.face_count(), 3);
  EXPECT_TRUE(analyse(result).is_oriented_manifold()) << analyse(result).defects();
}

/// A ridge between two flat pieces is where to divide, wherever the middle is; a round arc is
/// divided in the middle, although a corner of its polygon may be a little farther from the chord.
TEST(WaySplit, IsAtARidgeOrInTheMiddle) {
  const WayPlace ridge = split_of_way({{0, 0, 0}, {1, 1, 0}, {4, 0, 0}});
  EXPECT_EQ(ridge.piece, 1U);
  EXPECT_EQ(ridge.share, 0);
  std::vector<Vec3> arc;
  for (int i = 0; i <= 7; ++i) {
    arc.push_back({std::cos(0.1 * i), std::sin(0.1 * i), 0});
  }
  const WayPlace middle = split_of_way(arc);
  EXPECT_EQ(middle.piece, 3U);
  EXPECT_NEAR(middle.share, 0.5, 1e-9);
  // A corner close to an end is no place to divide.
  EXPECT_EQ(split_of_way({{0, 0, 0}, {0, 0.2, 0}, {3, 0, 0}}).piece, 1U);
  EXPECT_GT(split_of_way({{0, 0, 0}, {0, 0.2, 0}, {3, 0, 0}}).share, 0.3);
}

/// A cell that bends one way is cut across that way: 2^n columns and one row. A column of width w
/// is off by k w^2 / 8, so the tolerance decides n.
TEST(WaySplit, CornersAreWhereAChainLeavesStraightPieces) {
  // A tooth of height 1, and one of 0.1.
  const std::vector<Vec3> way = {{0, 0, 0}, {1, 0, 0},   {1.5, 1, 0}, {2, 0, 0},
                                 {3, 0, 0}, {4, 0.1, 0}, {5, 0, 0}};
  EXPECT_EQ(corners_of_way(way, 0.2), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(corners_of_way(way, 0.04), (std::vector<std::size_t>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(corners_of_way(way, 1).empty());
  EXPECT_TRUE(corners_of_way({{0, 0, 0}, {1, 0, 0}}, 0).empty());
  EXPECT_EQ(height_of_way(way), 1);
  EXPECT_EQ(height_of_way({}), 0);
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
/// triangles as the surface. \param shift  of the pentagon's corner beyond the ridge, away from it
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

/// New vertices on a sharp rim lie on the rim, in the middle of its arc, not of the chord.
TEST(SurfacePoints, MiddlesOfRimsAreOnTheRim) {
  SampleOptions sample;
  sample.faces = 8000;
  sample.jitter = 0.0;
  SilentObserver observer;
  const TriMesh mesh =
      import_mesh(make_sample(SampleKind::cylinder, sample), ImportOptions{}, observer).mesh;
  const SurfacePoints points(mesh);
  Index start = 0;
  while (mesh.is_feature[start] == 0) ++start;
  const auto at_vertex = [](Index h) {
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 1;
    return point;
  };
  // Some edges on along the rim, with a circle's chord between.
  Index h = start;
  for (int i = 0; i < 10; ++i) {
    Index next = TriMesh::next(h);
    while (mesh.is_feature[next] == 0) next = mesh.rotate_cw(next);
    h = next;
  }
  const SurfacePoint a = at_vertex(start);
  const SurfacePoint b = at_vertex(h);
  const Vec3 chord = (place_of(mesh, a) + place_of(mesh, b)) / 2;
  const SurfacePoint middle = points.between(a, b, chord, Vec3::UnitZ());
  const Vec3 place = place_of(mesh, middle);
  EXPECT_TRUE(points.is_on_line(middle));
  EXPECT_NEAR(std::abs(place.z()), kCylinderHalfHeight, 1e-9);
  // On the rim's polygon, between radius and its apothem; on the bisector of a and b.
  EXPECT_GT(std::hypot(place.x(), place.y()), 0.995 * kCylinderRadius);
  EXPECT_NEAR((place - place_of(mesh, a)).norm(), (place - place_of(mesh, b)).norm(), 0.01);
}

/// Across a deep valley the middle of the way lies at its bottom, where the point nearest to the
/// chord lies on a bank.
TEST(SurfacePoints, MiddlesStayOnTheWayOverTheSurface) {
  const Case c =
      grid(64, 2, [](double x, double) { return -2 * std::exp(-50 * (x - 0.5) * (x - 0.5)); });
  const SurfacePoints points(c.mesh);
  // Vertices 3 and 5 are at y = 0.5, on the two banks; the way between is about 4.1 long.
  const auto middle = split_of_section(c.mesh, foot(c, 3), foot(c, 5), Vec3::UnitZ(), 10);
  ASSERT_TRUE(middle.has_value());
  EXPECT_NEAR(place_of(c.mesh, *middle).z(), -2, 0.01);
  EXPECT_NEAR(place_of(c.mesh, *middle).x(), 0.5, 0.01);
  EXPECT_FALSE(split_of_section(c.mesh, foot(c, 3), foot(c, 5), Vec3::UnitZ(), 4).has_value());
  // On one bank, between vertices 5 and 8, it is the middle of the edge.
  const Vec3 chord = (c.quads.mesh.positions[5] + c.quads.mesh.positions[8]) / 2;
  EXPECT_NEAR(
      (place_of(c.mesh, points.between(foot(c, 5), foot(c, 8), chord, Vec3::UnitZ())) - chord)
          .norm(),
      0, 1e-9);
}

/// An edge of a result over a jagged boundary has its new vertices on that, whether it ends at
/// corners or passes them.
TEST(SurfacePoints, LeadAlongJaggedBoundaries) {
  Case c = toothed_sheet(8, 1, 0.1);
  std::ranges::fill(c.mesh.is_corner, 1);  // the whole boundary turns
  const SurfacePoints points(c.mesh);
  // Around the surface on the left: from the right end of the toothed side to its left one.
  const SurfacePoint right = foot(c, 3);
  const SurfacePoint left = foot(c, 2);
  EXPECT_NEAR(points.boundary_height(right, left), 0.1, 1e-12);
  const auto middle = points.between_on_boundary(right, left);
  ASSERT_TRUE(middle.has_value());
  // Tooth 3 or 4: the middle of the way is between them, and clearly less far from the chord.
  EXPECT_NEAR(place_of(c.mesh, *middle).y() + c.mesh.origin.y(), 1.1, 1e-12);
  // Not the long way around, against the sense of the boundary.
  EXPECT_FALSE(points.between_on_boundary(left, right).has_value());
  EXPECT_EQ(points.boundary_height(left, right), 0);
}

/// The middle of an edge across a notch is not where the boundary has its vertex.
TEST(SurfacePoints, MiddlesOfInnerEdgesLeaveTheBoundaryItsVertices) {
  const Case c = toothed_sheet(8, 1, 0.02);
  const SurfacePoints points(c.mesh);
  const auto tip = [&](Index tooth) { return SurfacePoint{2 * 8 * 8 + tooth, {0, 1, 0}}; };
  const Vec3 a = place_of(c.mesh, tip(3));
  const Vec3 b = place_of(c.mesh, tip(4));
  const Vec3 place = place_of(c.mesh, points.between(tip(3), tip(4), (a + b) / 2, Vec3::UnitZ()));
  for (const Vec3& p : c.mesh.positions) EXPECT_GT((p - place).norm(), 1e-3);
}

/// Where an edge spans a hole, and the faces beside it are turned over, its middle stays on the
/// sheet of its ends.
TEST(SurfacePoints, MiddlesStayOnTheirSheetWhereFacesAreTurnedOver) {
  PolyMesh soup;
  for (const double z : {0.0, -3.0}) {
    const Index first = soup.vertex_count();
    for (Index i = 0; i < 16; ++i) soup.positions.emplace_back(i % 4, i / 4, z);
    for (Index y = 0; y < 3; ++y) {
      for (Index x = 0; x < 3; ++x) {
        if (x == 1 && y == 1) continue;  // the hole
        const Index a = first + 4 * y + x;
        std::array<Index, 3> lower = {a, a + 1, a + 5};
        std::array<Index, 3> upper = {a, a + 5, a + 4};
        if (z < 0) {
          std::swap(lower[0], lower[1]);
          std::swap(upper[0], upper[1]);
        }
        soup.add_face(lower);
        soup.add_face(upper);
      }
    }
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  std::ranges::fill(mesh.is_corner, 1);  // so that no line goes around the hole
  const SurfacePoints points(mesh);
  const auto at_vertex = [&](Index v) {
    const Index h = mesh.vertex_out[v];
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 1;
    return point;
  };
  // Opposite corners of the hole.
  const Vec3 middle = (mesh.positions[5] + mesh.positions[10]) / 2;
  const SurfacePoint found =
      points.between(at_vertex(5), at_vertex(10), middle, Vec3(-Vec3::UnitZ()));
  EXPECT_NEAR(place_of(mesh, found).z(), mesh.positions[5].z(), 1e-12);
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

}  // namespace
}  // namespace strake
