#include "stages/mesh/simplify.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/grid_cells.h"

namespace strake {
namespace {

/// A torus of 3 by `around` vertices: every three around the tube are a ring of three edges that
/// bounds no face.
TriMesh thin_torus(Index around) {
  PolyMesh soup;
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < 3; ++j) {
      const double a = 2 * M_PI * i / around;
      const double b = 2 * M_PI * j / 3;
      const double r = 1 + 0.3 * std::cos(b);
      soup.positions.emplace_back(r * std::cos(a), r * std::sin(a), 0.3 * std::sin(b));
    }
  }
  const auto vertex = [&](Index i, Index j) { return i % around * 3 + j % 3; };
  for (Index i = 0; i < around; ++i) {
    for (Index j = 0; j < 3; ++j) {
      const Index v = vertex(i, j);
      const Index right = vertex(i + 1, j);
      const Index up = vertex(i, j + 1);
      const Index across = vertex(i + 1, j + 1);
      soup.add_face(std::array<Index, 3>{v, right, across});
      soup.add_face(std::array<Index, 3>{v, across, up});
    }
  }
  return support::plain_tri_mesh(soup);
}

/// The triangles themselves as cells.
PolygonGraph triangle_graph(const TriMesh& mesh) {
  Overlay overlay = overlay_of(mesh);
  for (EdgeKind& kind : overlay.kind) kind = EdgeKind::line;
  return PolygonGraph(mesh, overlay);
}

std::set<Index> neighbours(const PolygonGraph& graph, Index dart) {
  std::set<Index> result;
  for (const Index d : darts_around(graph.graph(), dart)) result.insert(graph.graph().to(d));
  return result;
}

TEST(CanContract, HoldsToTheLinkCondition) {
  // Four sections are rings of four, the three of a section are rings of three.
  for (const Index around : {4, 5, 12}) {
    const TriMesh mesh = thin_torus(around);
    const PolygonGraph graph = triangle_graph(mesh);
    const DartGraph& g = graph.graph();
    ASSERT_EQ(count(g).euler(), 0);
    int allowed = 0;
    for (Index d = 0; d < g.dart_count(); ++d) {
      const std::set<Index> here = neighbours(graph, d);
      const std::set<Index> there = neighbours(graph, DartGraph::opposite(d));
      std::set<Index> common;
      for (const Index n : here) {
        if (there.count(n) != 0) common.insert(n);
      }
      // In a triangle mesh an edge may be contracted where its ends share two neighbours, those
      // of its two faces (Dey et al. 1999).
      if (common.size() != 2) {
        EXPECT_FALSE(can_contract(graph, d)) << "dart " << d;
      } else {
        allowed += can_contract(graph, d);
      }
    }
    EXPECT_GT(allowed, 0) << around << " sections";
  }
}

TEST(Simplify, KeepsTheTopologyWhateverIsTooShort) {
  for (const Index around : {4, 7, 30}) {
    const TriMesh mesh = thin_torus(around);
    for (const double size : {0.1, 0.5, 1.0, 10.0}) {
      PolygonGraph graph = triangle_graph(mesh);
      const SimplifyCounts counts =
          simplify(graph, [&](const SurfaceNode&) { return size; }, {.shortest = 0.9});
      ASSERT_TRUE(is_consistent(graph.graph()));
      EXPECT_EQ(count(graph.graph()).euler(), 0);
      EXPECT_EQ(count(graph.graph()).parts, 1);
      if (size == 10.0) {
        EXPECT_GT(counts.contracted_edges, 0);
      }
    }
  }
}

/// Where the barrier nodes inside a strip are that a feature enters from the left, and that lines
/// cross at 2 and 4.
/// \param end  of the feature, beyond 4
std::set<double> nodes_on_feature(double end) {
  const Grid grid{{0, 1, 2, 3, 4, end, 8, 9}, steps(5)};
  TriMesh mesh = grid_mesh(grid);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 p = mesh.positions[v] + mesh.origin;
    if (p.x() == end && p.y() == 2) mesh.is_corner[v] = 1;
  }
  PolygonGraph graph = cells_of(
      mesh,
      [](const Vec3& a, const Vec3& b) { return a.x() == b.x() && (a.x() == 2 || a.x() == 4); },
      [&](const Vec3& a, const Vec3& b) {
        return a.y() == 2 && b.y() == 2 && std::max(a.x(), b.x()) <= end;
      });
  simplify(graph, [](const SurfaceNode&) { return 2.0; }, {.shortest = 0.3});
  EXPECT_TRUE(is_consistent(graph.graph()));
  EXPECT_EQ(count(graph.graph()).loose_ends, 0);
  std::set<double> found;
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (!g.is_alive(d)) continue;
    const Vec3 p = graph.position(g.from(d)) + mesh.origin;
    if (p.y() == 2 && p.x() > 0 && p.x() < 8) found.insert(p.x());
  }
  return found;
}

// A crease that fades out inside a cell has its end in the result, where a line is near.
TEST(Simplify, BringsTheLastCrossingOfAFeatureToItsEnd) {
  EXPECT_EQ(nodes_on_feature(5), (std::set<double>{2, 5}));
  EXPECT_EQ(nodes_on_feature(5.25), (std::set<double>{2, 5.25}));
  EXPECT_EQ(nodes_on_feature(7), (std::set<double>{2, 4})) << "too far away";
}

/// Length of the shortest edge over that of the mean one.
double shortest_over_mean(const PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  double shortest = std::numeric_limits<double>::infinity();
  double sum = 0;
  int edges = 0;
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d)) continue;
    const double length = (graph.position(g.to(d)) - graph.position(g.from(d))).norm();
    shortest = std::min(shortest, length);
    sum += length;
    ++edges;
  }
  return shortest * edges / sum;
}

/// A unit cube of triangles around a point of each side, which is this far from one of its corners.
TriMesh cube_with_points(double distance) {
  PolyMesh soup;
  for (Index v = 0; v < 8; ++v) soup.positions.emplace_back(v & 1, v >> 1 & 1, v >> 2);
  const std::array<std::array<Index, 4>, 6> sides = {
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (std::size_t s = 0; s < 6; ++s) {
    const Vec3& corner = soup.positions[sides[s][s % 4]];
    const Vec3& beyond = soup.positions[sides[s][(s + 2) % 4]];
    const Index inside = soup.vertex_count();
    soup.positions.emplace_back(corner + distance * (beyond - corner).normalized());
    for (std::size_t i = 0; i < 4; ++i) {
      soup.add_face(std::array<Index, 3>{sides[s][i], sides[s][(i + 1) % 4], inside});
    }
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  for (Index v = 0; v < 8; ++v) mesh.is_corner[v] = 1;
  return mesh;
}

// The normals of all other corners of a cell may be those of the sides beyond.
TEST(Simplify, MergesNodesBesideCorners) {
  const TriMesh mesh = cube_with_points(1e-3);
  PolygonGraph graph = cells_of(
      mesh, [](const Vec3&, const Vec3&) { return true; },
      [](const Vec3& a, const Vec3& b) { return std::abs((b - a).norm() - 1) < 1e-9; });
  const SimplifyCounts counts = simplify(graph, [](const SurfaceNode&) { return 1.0; },
                                         {.shortest = 0.3, .corner_distance = 0});
  EXPECT_EQ(counts.contracted_edges, 6);
  EXPECT_EQ(count(graph.graph()).euler(), 2);
  EXPECT_GT(shortest_over_mean(graph), 0.5);
}

// A line that goes around the tip of a cone is such a loop. Where it was is a vertex of four edges.
TEST(Simplify, RemovesTinyLoops) {
  const auto graph_with_loop = [](const TriMesh& mesh, double width) {
    const double end = 2 + width;
    return cells_of(mesh, [=](const Vec3& a, const Vec3& b) {
      const auto is_at = [&](double x, double y) {
        return x == 2 || x == end || y == 2 || y == end;
      };
      const bool is_on_loop = std::min({a.x(), b.x(), a.y(), b.y()}) >= 2 &&
                              std::max({a.x(), b.x(), a.y(), b.y()}) <= end;
      if (is_on_loop) return (a.x() == b.x() || a.y() == b.y()) && is_at(a.x(), a.y());
      return (a.x() == 2 && b.x() == 2 && std::max(a.y(), b.y()) <= 2) ||
             (a.y() == 2 && b.y() == 2 && std::max(a.x(), b.x()) <= 2);
    });
  };
  for (const double width : {0.004, 1.0}) {
    const std::vector<double> places = {0, 1, 2, 2 + width, 4};
    const TriMesh mesh = grid_mesh({places, places});
    PolygonGraph graph = graph_with_loop(mesh, width);
    const SimplifyCounts counts =
        simplify(graph, [](const SurfaceNode&) { return 2.0; }, {.shortest = 0.3});
    EXPECT_TRUE(is_consistent(graph.graph()));
    EXPECT_EQ(count(graph.graph()).euler(), 2);
    EXPECT_EQ(count(graph.graph()).loose_ends, 0);
    EXPECT_EQ(counts.removed_loops, width < 0.1 ? 1 : 0);
    EXPECT_GT(shortest_over_mean(graph), 0.3);
    const DartGraph& g = graph.graph();
    Index degree = 0;
    for (Index d = 0; d < g.dart_count(); ++d) {
      if (g.is_alive(d) && (graph.position(g.from(d)) + mesh.origin).isApprox(Vec3(2, 2, 0))) {
        degree = graph.degree(d);
      }
    }
    EXPECT_EQ(degree, 4);
  }
}

}  // namespace
}  // namespace strake
