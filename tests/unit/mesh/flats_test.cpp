#include "stages/mesh/flats.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "stages/mesh/cell_shape.h"
#include "stages/mesh/partition.h"
#include "stages/mesh/simplify.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

constexpr Index kSize = 9;
constexpr Index kLargeSize = 30;

/// A grid of unit squares at z = 0, each cut in two.
/// \param size       nodes along a side
/// \param has_holes  every ninth square is left out
TriMesh grid(Index size = kSize, bool has_holes = false) {
  const auto is_hole = [&](Index x, Index y) { return has_holes && x % 3 == 2 && y % 3 == 2; };
  PolyMesh soup;
  for (Index y = 0; y < size; ++y) {
    for (Index x = 0; x < size; ++x) soup.positions.emplace_back(x, y, 0);
  }
  for (Index y = 0; y + 1 < size; ++y) {
    for (Index x = 0; x + 1 < size; ++x) {
      if (is_hole(x, y)) continue;
      const Index v = y * size + x;
      soup.add_face(std::array<Index, 3>{v, v + 1, v + 1 + size});
      soup.add_face(std::array<Index, 3>{v, v + 1 + size, v + size});
    }
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  std::ranges::fill(mesh.is_corner, 1);  // every vertex of the boundary stays a node
  return mesh;
}

/// The triangles of a mesh as cells. The mesh must outlive them.
PolygonGraph triangle_cells(const TriMesh& mesh) {
  Overlay overlay = overlay_of(mesh);
  for (EdgeKind& kind : overlay.kind) {
    if (kind == EdgeKind::surface) kind = EdgeKind::line;
  }
  return {mesh, overlay};
}

double turn(const Vec3& a, const Vec3& b, const Vec3& c) { return (b - a).cross(c - a).z(); }

/// Pairs of edges at z = 0 without a node in common that cross, each tried against each.
int crossing_edges(const PolygonGraph& graph, bool features_only) {
  const DartGraph& g = graph.graph();
  std::vector<Index> edges;
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (g.is_alive(d) && (!features_only || graph.is_barrier(d))) edges.push_back(d);
  }
  int count = 0;
  for (const Index d : edges) {
    for (const Index e : edges) {
      const Index ends[] = {g.from(d), g.to(d), g.from(e), g.to(e)};
      if (e <= d || ends[0] == ends[2] || ends[0] == ends[3] || ends[1] == ends[2] ||
          ends[1] == ends[3]) {
        continue;
      }
      const auto at = [&](int i) { return graph.position(ends[i]); };
      count += turn(at(0), at(1), at(2)) * turn(at(0), at(1), at(3)) < 0 &&
               turn(at(2), at(3), at(0)) * turn(at(2), at(3), at(1)) < 0;
    }
  }
  return count;
}

/// Cells at z = 0 that are seen from below, or from the side.
int turned_cells(const PolygonGraph& graph) {
  int count = 0;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d) || graph.is_hole(d) || graph.name_of_cell(d) != d) continue;
    count += !(vector_area(corner_positions(graph, graph.cell(d))).z() > 0);
  }
  return count;
}

TEST(RedrawFlats, LeavesADrawingAsItIs) {
  const TriMesh mesh = grid();
  PolygonGraph graph = triangle_cells(mesh);
  EXPECT_EQ(redraw_flats(graph), 0);
  EXPECT_EQ(count(graph.graph()).edges, count(triangle_cells(mesh).graph()).edges);
}

// Nodes that have moved past their neighbours, as straight edges do around a corner.
TEST(RedrawFlats, UntanglesWhateverIsTurned) {
  const TriMesh mesh = grid();
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> shift(-1.4, 1.4);
  int tangled = 0;
  for (int trial = 0; trial < 30; ++trial) {
    PolygonGraph graph = triangle_cells(mesh);
    const Index euler = count(graph.graph()).euler();
    for (int i = 0; i < 1 + trial; ++i) {
      const auto n = static_cast<Index>(random() % graph.node_count());
      if (graph.rank(n) != NodeRank::line) continue;
      const Vec3 moved = graph.position(n) + Vec3(shift(random), shift(random), 0);
      graph.move(n, moved.cwiseMax(0.1).cwiseMin(kSize - 1.1).cwiseProduct(Vec3(1, 1, 0)));
    }
    tangled += crossing_edges(graph, false) > 0;
    redraw_flats(graph);
    EXPECT_EQ(crossing_edges(graph, false), 0) << "trial " << trial;
    EXPECT_EQ(turned_cells(graph), 0) << "trial " << trial;
    EXPECT_TRUE(is_consistent(graph.graph()));
    EXPECT_EQ(count(graph.graph()).euler(), euler);
    EXPECT_EQ(count(graph.graph()).parts, 1);
  }
  EXPECT_GT(tangled, 20);
}

// Where a gap takes in what is around it, edges between holes come to have it on both sides.
TEST(RedrawFlats, FillsGapsBetweenManyHoles) {
  const TriMesh mesh = grid(kLargeSize, true);
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> shift(-12, 12);
  for (int trial = 0; trial < 10; ++trial) {
    PolygonGraph graph = triangle_cells(mesh);
    const DartGraph& g = graph.graph();
    for (Index d = 0; d < g.dart_count(); d += 2) {
      if (!g.is_alive(d) || graph.is_barrier(d) || random() % 3 != 0) continue;
      const Index other = DartGraph::opposite(d);
      if (graph.name_of_cell(d) == graph.name_of_cell(other)) continue;
      if (graph.degree(d) > 2 && graph.degree(other) > 2) graph.remove_edge(d);
    }
    for (int i = 0; i < 64; ++i) {
      const auto n = static_cast<Index>(random() % graph.node_count());
      if (graph.rank(n) != NodeRank::line) continue;
      const Vec3 moved = graph.position(n) + Vec3(shift(random), shift(random), 0);
      graph.move(n, moved.cwiseMax(0.1).cwiseMin(kLargeSize - 1.1).cwiseProduct(Vec3(1, 1, 0)));
    }
    EXPECT_GT(crossing_edges(graph, false), 0);
    redraw_flats(graph);
    EXPECT_EQ(crossing_edges(graph, false), 0) << "trial " << trial;
    EXPECT_TRUE(is_consistent(graph.graph()));
  }
}

TEST(RedrawFlats, LeavesWhatIsBent) {
  const TriMesh mesh = grid();
  PolygonGraph graph = triangle_cells(mesh);
  for (Index n = 0; n < graph.node_count(); ++n) {
    const Vec3& p = graph.position(n);
    graph.move(n, p + Vec3(0, 0, 0.3 * (p.x() * p.x() + p.y() * p.y())));
  }
  EXPECT_EQ(redraw_flats(graph), 0);
}

// Both sides of a sheet are one flat part, and lie on each other: nothing can be drawn there.
TEST(RedrawFlats, KeepsTheTopologyOfAFlattenedSphere) {
  SampleOptions options;
  options.faces = 500;
  const TriMesh mesh = support::plain_tri_mesh(make_sample(SampleKind::sphere, options));
  for (const double height : {0.0, 1e-3}) {
    PolygonGraph graph = triangle_cells(mesh);
    for (Index n = 0; n < graph.node_count(); ++n) {
      graph.move(n, graph.position(n).cwiseProduct(Vec3(1, 1, height)));
    }
    redraw_flats(graph);
    EXPECT_TRUE(is_consistent(graph.graph()));
    EXPECT_EQ(count(graph.graph()).euler(), 2) << height;
    EXPECT_EQ(count(graph.graph()).parts, 1) << height;
  }
}

/// Fans of triangles around the second node of each outline; squares have the other diagonal.
std::vector<std::array<Index, 3>> fans(const PolygonGraph& graph,
                                       const std::vector<std::vector<Index>>& outlines) {
  std::vector<std::array<Index, 3>> triangles;
  for (const std::vector<Index>& o : outlines) {
    const auto node = [&](std::size_t i) { return graph.graph().from(o[i % o.size()]); };
    for (std::size_t i = 2; i < o.size(); ++i) {
      triangles.push_back({node(1), node(i), node(i + 1)});
    }
  }
  return triangles;
}

// A ring of cells has two outlines, each of which triangles could fill.
TEST(Refill, TakesNoTrianglesThatCutTheSurfaceApart) {
  const TriMesh mesh = grid();
  PolygonGraph graph = triangle_cells(mesh);
  const DartGraph& g = graph.graph();
  const auto is_in_ring = [&](Index d) {
    const Vec3 p = vector_area(corner_positions(graph, graph.cell(d)));
    Vec3 middle = Vec3::Zero();
    for (const Vec3& corner : corner_positions(graph, graph.cell(d))) middle += corner / 3;
    const double away = (middle - Vec3(4.5, 4.5, 0)).cwiseAbs().maxCoeff();
    return p.z() > 0 && away > 0.5 && away < 1.5 && !graph.is_hole(d);
  };
  std::vector<Index> inside;
  std::map<Index, Index> leaving;  // the outlines' dart from each node
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (!is_in_ring(d)) continue;
    if (!is_in_ring(DartGraph::opposite(d))) {
      leaving[g.from(d)] = d;
    } else if (d % 2 == 0) {
      inside.push_back(d);
    }
  }
  ASSERT_EQ(leaving.size(), 16u);
  std::vector<std::vector<Index>> outlines;
  while (!leaving.empty()) {
    std::vector<Index> outline;
    for (auto at = leaving.begin(); at != leaving.end(); at = leaving.find(g.to(outline.back()))) {
      outline.push_back(at->second);
      leaving.erase(at);
    }
    outlines.push_back(std::move(outline));
  }
  ASSERT_EQ(outlines.size(), 2u);
  EXPECT_TRUE(graph.refill(outlines, inside, fans(graph, outlines)).empty());
  EXPECT_EQ(count(g).edges, count(triangle_cells(mesh).graph()).edges);
  EXPECT_EQ(count(g).parts, 1);
}

const Vec3 kCentre(-0.08, 0, 0);  ///< of the inner circle

constexpr Index kSides = 96;

/// A ring between two circles of many edges that nearly touch. A triangle in the inner one with a
/// corner where they are farthest apart reaches out of that in the outer one.
TriMesh narrow_ring() {
  PolyMesh soup;
  for (Index i = 0; i < kSides; ++i) {
    const double angle = 2 * M_PI * i / kSides;
    const Vec3 outer(std::cos(angle), std::sin(angle), 0);
    soup.positions.insert(soup.positions.end(), {kCentre + 0.9 * outer, outer});
  }
  for (Index i = 0; i < 2 * kSides; i += 2) {
    const Index next = (i + 2) % (2 * kSides);
    soup.add_face(std::array<Index, 3>{i, i + 1, next + 1});
    soup.add_face(std::array<Index, 3>{i, next + 1, next});
  }
  return support::plain_tri_mesh(soup);
}

/// Three cells of that ring, between lines from one circle to the other at the corners of those
/// triangles.
PolygonGraph three_cells(const TriMesh& mesh) {
  Overlay overlay = overlay_of(mesh);
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    const auto [a, b] = std::minmax({overlay.graph.from(2 * e), overlay.graph.to(2 * e)});
    if (a % (2 * kSides / 3) == 0 && b == a + 1) overlay.kind[e] = EdgeKind::line;
  }
  reduce_to_lines(overlay);
  return {mesh, overlay};
}

TEST(SplitCrossingFeatures, BringsThemBackToTheirCourse) {
  const TriMesh mesh = narrow_ring();
  PolygonGraph graph = three_cells(mesh);
  simplify(graph, [](const SurfaceNode&) { return 12.0; }, {.shortest = 0.3});
  ASSERT_GT(crossing_edges(graph, true), 0) << "the ring is finer than its edges";
  EXPECT_GT(split_crossing_features(graph), 0);
  EXPECT_EQ(crossing_edges(graph, true), 0);
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    const Vec3& p = graph.position(graph.graph().from(d));
    EXPECT_LT(std::min(std::abs((p - kCentre).norm() - 0.9), std::abs(p.norm() - 1)), 1e-12);
  }
  EXPECT_LT(count(graph.graph()).nodes, 60) << "of 192";
  partition(graph, 5);
  redraw_flats(graph);
  EXPECT_EQ(crossing_edges(graph, false), 0);
  EXPECT_EQ(turned_cells(graph), 0);
}

}  // namespace
}  // namespace strake
