#include "stages/mesh/cell_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "stages/mesh/partition.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

constexpr Index kRows = 4;
constexpr Index kColumns = 96;  ///< per turn

/// A strip that winds up along a cylinder of radius 1, open on all sides. Vertex 4 i + r is in row
/// r.
TriMesh spiral(Index columns) {
  PolyMesh soup;
  for (Index i = 0; i <= columns; ++i) {
    const double angle = 2 * M_PI * i / kColumns;
    for (Index r = 0; r < kRows; ++r) {
      soup.positions.emplace_back(std::cos(angle), std::sin(angle), 0.1 * r + angle / (2 * M_PI));
    }
  }
  for (Index i = 0; i < columns; ++i) {
    for (Index r = 0; r + 1 < kRows; ++r) {
      const Index at = kRows * i + r;
      soup.add_face(std::array<Index, 3>{at, at + kRows, at + kRows + 1});
      soup.add_face(std::array<Index, 3>{at, at + kRows + 1, at + 1});
    }
  }
  return support::plain_tri_mesh(soup);
}

/// Cells of that strip between two lines along it. Others run across it up to these, every `step`
/// columns and in turn on both sides, so that one cell winds all the way between them.
PolygonGraph winding_cell(const TriMesh& mesh, Index step) {
  Overlay overlay = overlay_of(mesh);
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    const auto [a, b] = std::minmax({overlay.graph.from(2 * e), overlay.graph.to(2 * e)});
    const Index row = a % kRows;
    const bool along = b == a + kRows && (row == 1 || row == 2);
    const bool across =
        b == a + 1 && row != 1 && (a / kRows + (row == 0 ? 0 : step / 2)) % step == 0;
    if (along || across) overlay.kind[e] = EdgeKind::line;
  }
  reduce_to_lines(overlay);
  return PolygonGraph(mesh, overlay);
}

/// The largest angle around the cylinder's axis that an edge cuts off.
double widest_chord(const PolygonGraph& graph) {
  double widest = 0;
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d)) continue;
    const Vec3 middle = 0.5 * (graph.position(g.from(d)) + graph.position(g.to(d)));
    widest = std::max(widest, 2 * std::acos(std::min(1.0, middle.head<2>().norm())));
  }
  return widest;
}

// No direction shows such a cell from one side only. Divided as one sees it along its normal it
// had edges through the cylinder.
TEST(Partition, KeepsAWindingCellOnItsSurface) {
  for (const Index columns : {kColumns * 3 / 4, kColumns * 3 / 2, kColumns * 4}) {
    for (const Index step : {8, 12}) {
      const TriMesh mesh = spiral(columns);
      const EdgeHeights heights(mesh);
      PolygonGraph graph = winding_cell(mesh, step);
      partition(graph, 5, &heights);
      // From a corner those on the other side are half a step and one and a half away.
      EXPECT_LT(widest_chord(graph), 2 * step * 2 * M_PI / kColumns)
          << columns << " columns, lines every " << step;
    }
  }
}

TEST(CellView, SeesAcrossAWindingCell) {
  const TriMesh mesh = spiral(kColumns * 3 / 2);
  const PolygonGraph graph = winding_cell(mesh, 8);
  DartLoop cell;
  graph.for_each_cell([&](Index, const DartLoop& c) {
    if (c.size() > cell.size()) cell = c;
  });
  const Polygon p = corner_positions(graph, cell);
  const CellView view(graph, cell, p);
  ASSERT_TRUE(view.is_folded());
  const auto is_lower = [&](std::size_t i) {
    const double rise = p[i].z() - std::atan2(p[i].y(), p[i].x()) / (2 * M_PI);
    return rise - std::floor(rise) < 0.15;
  };
  // Corners at the ends of the strip are seen as their neighbours are.
  const auto is_on_line = [&](std::size_t i) {
    return graph.rank(graph.graph().from(cell[i])) == NodeRank::line;
  };
  for (std::size_t i = 0; i < cell.size(); ++i) {
    if (!is_on_line(i)) continue;
    // A line ends on a vertex: the normal is that of a face beside it, half a column away.
    EXPECT_GT(view.normal(i).dot(Vec3(p[i].x(), p[i].y(), 0)), std::cos(2 * M_PI / kColumns));
    for (std::size_t j = i + 2; j < cell.size(); ++j) {
      if (!is_on_line(j)) continue;
      const double around = (p[i].head<2>() - p[j].head<2>()).norm();
      const bool same_turn = std::abs(p[i].z() - p[j].z()) < 0.3;
      if (same_turn && is_lower(i) != is_lower(j) && around < 0.3) {
        EXPECT_TRUE(view.contains(i, j)) << "a rung from " << i << " to " << j;
      } else if (is_lower(i) == is_lower(j) && around < 1) {
        EXPECT_FALSE(view.contains(i, j)) << "along a side from " << i << " to " << j;
      }
    }
  }
}

}  // namespace
}  // namespace strake
