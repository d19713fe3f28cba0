#include "stages/mesh/simplify.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "common/core/poly_mesh.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

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

}  // namespace
}  // namespace strake
