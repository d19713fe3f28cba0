#include "stages/mesh/off_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "stages/mesh/cell_shape.h"
#include "stages/mesh/partition.h"
#include "stages/mesh/simplify.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

constexpr Index kSides = 48;

/// The wall of a hole, open at both ends. Vertices 2 i and 2 i + 1 are at its two rims.
TriMesh wall(double length) {
  PolyMesh soup;
  for (Index i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    for (const double z : {0.0, length}) {
      soup.positions.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  for (Index i = 0; i < 2 * kSides; i += 2) {
    const Index next = (i + 2) % (2 * kSides);
    soup.add_face(std::array<Index, 3>{i, next + 1, next});
    soup.add_face(std::array<Index, 3>{i, i + 1, next + 1});
  }
  return support::plain_tri_mesh(soup);
}

/// Cells of the wall between `lines` lines from rim to rim, the rims divided where they are bent.
PolygonGraph few_cells(const TriMesh& mesh, Index lines) {
  Overlay overlay = overlay_of(mesh);
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    const auto [a, b] = std::minmax({overlay.graph.from(2 * e), overlay.graph.to(2 * e)});
    if (a % (2 * kSides / lines) == 0 && b == a + 1) overlay.kind[e] = EdgeKind::line;
  }
  reduce_to_lines(overlay);
  PolygonGraph graph(mesh, overlay);
  simplify(graph, [](const SurfaceNode&) { return 2.0; }, {.shortest = 0.3});
  return graph;
}

/// How far edges are off the wall at most, as a share of the radius.
double farthest_off(const PolygonGraph& graph) {
  double farthest = 0;
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d)) continue;
    const Vec3 middle = 0.5 * (graph.position(g.from(d)) + graph.position(g.to(d)));
    farthest = std::max(farthest, 1 - middle.head<2>().norm());
  }
  return farthest;
}

// Of two cells between two lines, each half of the wall, edges along one rim would make caps.
TEST(Partition, KeepsTheWallOfAHoleOpen) {
  for (const double length : {0.5, 1.0, 3.0}) {
    const TriMesh mesh = wall(length);
    const EdgeHeights heights(mesh);
    for (const Index lines : {2, 3}) {
      PolygonGraph graph = few_cells(mesh, lines);
      const double rims = farthest_off(graph);
      ASSERT_LT(rims, 0.15) << "rims are divided";
      partition(graph, 4, &heights);
      EXPECT_LE(farthest_off(graph), rims) << lines << " lines, length " << length;
    }
  }
}

TEST(Partition, ClosesThatWallWhereOnlyShapesCount) {
  const TriMesh mesh = wall(0.5);
  PolygonGraph graph = few_cells(mesh, 2);
  partition(graph, 4);
  EXPECT_GT(farthest_off(graph), 0.5) << "else the other test shows nothing";
}

/// The wall, and the outline of one of its cells.
struct WallCell {
  explicit WallCell(Index lines) : mesh(wall(3)), heights(mesh), graph(few_cells(mesh, lines)) {
    graph.for_each_cell([&](Index, const DartLoop& cell) { outline = cell; });
  }

  TriMesh mesh;
  EdgeHeights heights;
  PolygonGraph graph;
  DartLoop outline;
};

TEST(OffSurface, PricesTheSquareOfTheShareThatAnEdgeIsOff) {
  const WallCell half(2);
  const OffSurface off(half.graph, half.outline, &half.heights);
  EXPECT_NEAR(off.price(Vec3(1, 0, 0), Vec3(1, 0, 3)), 0, 1e-12);
  // A chord of angle a is 1 - cos(a / 2) off in its middle, and 2 sin(a / 2) long.
  const double quarter = off.price(Vec3(1, 0, 1), Vec3(0, 1, 1));
  const double half_way = off.price(Vec3(1, 0, 1), Vec3(-1, 0, 1));
  const double share = (1 - std::cos(M_PI / 4)) / (2 * std::sin(M_PI / 4));
  EXPECT_NEAR(quarter / half_way, share * share / 0.25, 0.02);
  const OffSurface free(half.graph, half.outline, nullptr);
  EXPECT_EQ(free.price(Vec3(1, 0, 1), Vec3(-1, 0, 1)), 0);
}

TEST(OffSurface, LooksAwayWhereTheOutlineIsNearlyFlat) {
  const WallCell eighth(8);
  const OffSurface off(eighth.graph, eighth.outline, &eighth.heights);
  EXPECT_EQ(off.price(Vec3(1, 0, 1), Vec3(-1, 0, 1)), 0);
}

}  // namespace
}  // namespace strake
