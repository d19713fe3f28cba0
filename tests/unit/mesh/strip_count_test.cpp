#include "stages/mesh/strip_count.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/grid_cells.h"

namespace strake {
namespace {

bool is_straight(const Vec3& a, const Vec3& b) { return !is_diagonal(a, b); }

/// All edges of a grid but the part of the line x = 2.4 outside of (from, to).
KeepEdge with_part_of_a_line(double from, double to) {
  return [=](const Vec3& a, const Vec3& b) {
    const double middle = (a.y() + b.y()) / 2;
    const bool is_on_line = a.x() == 2.4 && b.x() == 2.4;
    return is_straight(a, b) && (!is_on_line || (middle > from && middle < to));
  };
}

TEST(MeetVertexCount, SplitsTheWidestStripFromBoundaryToBoundary) {
  const TriMesh mesh = grid_mesh({{0, 1, 2, 4, 5}, steps(6)});
  PolygonGraph graph = cells_of(mesh, is_straight);
  const StripCounts counts = meet_vertex_count(graph, unit_length, 1, 36);
  EXPECT_EQ(counts.split, 1);
  EXPECT_EQ(sides(graph), (std::map<std::size_t, int>{{4, 25}}));
  EXPECT_EQ(places(graph, mesh),
            places(cells_of(grid_mesh({{0, 1, 2, 3, 4, 5}, steps(6)}), is_straight), mesh));
  EXPECT_TRUE(is_consistent(graph.graph()));
}

TEST(MeetVertexCount, ProlongsALineRatherThanBeginningOne) {
  // The line x = 2.4 ends in pentagons on both sides of the gap from y = 4 to y = 8.
  const TriMesh mesh = grid_mesh({{0, 1, 2, 2.4, 2.8, 4, 5}, steps(13)});
  const PolygonGraph whole = cells_of(mesh, is_straight);
  const auto gap = [](const Vec3& a, const Vec3& b) {
    const double middle = (a.y() + b.y()) / 2;
    const bool is_missing = a.x() == 2.4 && b.x() == 2.4 && middle > 4 && middle < 8;
    return is_straight(a, b) && !is_missing;
  };
  PolygonGraph graph = cells_of(mesh, gap);
  ASSERT_EQ(sides(graph)[5], 2);
  const auto before = static_cast<Index>(places(graph, mesh).size());
  meet_vertex_count(graph, unit_length, 1, before + 3);
  EXPECT_EQ(sides(graph), sides(whole));
  EXPECT_EQ(places(graph, mesh), places(whole, mesh));
}

TEST(MeetVertexCount, TakesALineBackThatEndsOnBothSides) {
  const TriMesh mesh = grid_mesh({{0, 1, 2, 2.4, 2.8, 4, 5}, steps(13)});
  const PolygonGraph without = cells_of(mesh, with_part_of_a_line(0, 0));
  PolygonGraph graph = cells_of(mesh, with_part_of_a_line(3, 9));
  ASSERT_EQ(sides(graph)[5], 2);
  const auto before = static_cast<Index>(places(graph, mesh).size());
  const auto fewer = static_cast<Index>(places(without, mesh).size());
  ASSERT_GT(before, fewer);
  const StripCounts counts = meet_vertex_count(graph, unit_length, 1, fewer);
  EXPECT_EQ(counts.collapsed, 1);
  EXPECT_EQ(sides(graph), sides(without));
  EXPECT_EQ(places(graph, mesh).size(), places(without, mesh).size());
  EXPECT_TRUE(is_consistent(graph.graph()));
}

TEST(MeetVertexCount, LeavesWhatNoStripBringsNearer) {
  const TriMesh mesh = grid_mesh({steps(6), steps(6)});
  PolygonGraph graph = cells_of(mesh, is_straight);
  const auto before = places(graph, mesh);
  // A strip has six rungs; lines that end on the boundary stay.
  for (const Index wanted : {36, 39, 33, 20}) {
    const StripCounts counts = meet_vertex_count(graph, unit_length, 1, wanted);
    EXPECT_EQ(counts.split + counts.collapsed, 0) << wanted;
  }
  EXPECT_EQ(places(graph, mesh), before);
}

TEST(MeetVertexCount, NeverJoinsTheMiddlesOfTwoRungsTwice) {
  // An octahedron of which only the equator is left: two quads back to back.
  PolyMesh soup;
  soup.positions = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  for (Index i = 0; i < 4; ++i) {
    const Index next = (i + 1) % 4;
    soup.add_face(std::array<Index, 3>{i, next, 4});
    soup.add_face(std::array<Index, 3>{next, i, 5});
  }
  const TriMesh mesh = support::plain_tri_mesh(soup);
  const auto is_equator = [](const Vec3& a, const Vec3& b) {
    return std::abs(a.z()) < 0.5 && std::abs(b.z()) < 0.5;
  };
  // Nodes of two edges stay where the kind of line changes.
  const auto every_other = [&](const Vec3& a, const Vec3& b) {
    return is_equator(a, b) && (a + b).x() * (a + b).y() > 0;
  };
  PolygonGraph graph = cells_of(mesh, is_equator, every_other);
  ASSERT_EQ(sides(graph), (std::map<std::size_t, int>{{4, 2}}));
  EXPECT_EQ(meet_vertex_count(graph, unit_length, 1, 6).split, 0);
}

/// Twice of it is more than an index holds.
TEST(MeetVertexCount, MoreMayBeMissingThanCanEverBe) {
  constexpr Index kMissing = 1'200'000'000;
  const TriMesh mesh = grid_mesh({{0, 1, 2, 3, 4, 5}, steps(6)});
  for (const Index missing : {100, kMissing}) {
    PolygonGraph graph = cells_of(mesh, is_straight);
    const auto before = static_cast<Index>(places(graph, mesh).size());
    EXPECT_GT(meet_vertex_count(graph, unit_length, 1, before + missing).split, 0) << missing;
  }
}

class CountedSurfaces : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Samples, CountedSurfaces,
                         ::testing::Values(SampleKind::torus, SampleKind::ellipsoid,
                                           SampleKind::open_cylinder),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(CountedSurfaces, ComeNearerToACountWithNoFewerQuads) {
  SampleOptions sample;
  sample.faces = 8000;
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample));
  TraceOptions options;
  options.vertices = 900;
  const LineSet lines = support::trace(prepared, options);
  const PolyMesh plain = support::mesh(prepared, lines, {}).mesh;
  const PolyTopology before = analyse(plain);
  for (const double factor : {0.9, 1.12}) {
    const auto wanted = std::llround(factor * plain.vertex_count());
    const PolyMesh nearer = support::mesh(prepared, lines, {.strip_vertices = wanted}).mesh;
    EXPECT_LT(2 * std::abs(nearer.vertex_count() - wanted), std::abs(plain.vertex_count() - wanted))
        << factor;
    const PolyTopology after = analyse(nearer);
    EXPECT_EQ(after.euler, before.euler);
    EXPECT_LE(nearer.face_count() - after.quads, plain.face_count() - before.quads);
    const PolyMesh pure =
        support::mesh(prepared, lines, {.pure_quads = true, .strip_vertices = wanted}).mesh;
    EXPECT_EQ(analyse(pure).quads, pure.face_count());
  }
}

}  // namespace
}  // namespace strake
