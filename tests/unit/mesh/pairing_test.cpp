#include "stages/mesh/pairing.h"

#include <gtest/gtest.h>

#include <functional>
#include <map>
#include <set>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "stages/mesh/pure_quads.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/grid_cells.h"

namespace strake {
namespace {

TEST(PairOddFaces, ProlongsALineAcrossAGap) {
  const Grid grid = {{0, 1, 2, 2.6, 3.2, 4, 5}, steps(9)};
  const TriMesh mesh = grid_mesh(grid);
  const PolygonGraph whole =
      cells_of(mesh, [](const Vec3& a, const Vec3& b) { return !is_diagonal(a, b); });
  // The line x = 2.6 is missing between y = 3 and y = 5.
  PolygonGraph graph = cells_of(mesh, [](const Vec3& a, const Vec3& b) {
    const double middle = (a.y() + b.y()) / 2;
    const bool gap = a.x() == 2.6 && b.x() == 2.6 && middle > 3 && middle < 5;
    return !is_diagonal(a, b) && !gap;
  });
  ASSERT_EQ(sides(graph)[5], 2);
  const PairingCounts counts = pair_odd_faces(graph, unit_length, 1);
  EXPECT_EQ(counts.split_strips, 1);
  EXPECT_EQ(sides(graph), sides(whole));
  EXPECT_EQ(places(graph, mesh), places(whole, mesh));
  EXPECT_TRUE(is_consistent(graph.graph()));
}

TEST(PairOddFaces, TakesBackAShortPieceOfALineBetweenNarrowOnes) {
  const Grid grid = {{0, 1, 2, 2.4, 2.8, 4, 5}, steps(12)};
  const TriMesh mesh = grid_mesh(grid);
  // The line x = 2.4 is there only between y = 5 and y = 7.
  const auto only = [](double from, double to) {
    return [=](const Vec3& a, const Vec3& b) {
      const double middle = (a.y() + b.y()) / 2;
      const bool on_line = a.x() == 2.4 && b.x() == 2.4;
      return !is_diagonal(a, b) && (!on_line || (middle > from && middle < to));
    };
  };
  PolygonGraph without = cells_of(mesh, only(0, 0));
  PolygonGraph graph = cells_of(mesh, only(5, 7));
  ASSERT_EQ(sides(graph)[5], 2);
  const PairingCounts counts = pair_odd_faces(graph, unit_length, 1);
  EXPECT_EQ(counts.collapsed_strips, 1);
  EXPECT_EQ(counts.split_strips, 0);
  EXPECT_EQ(sides(graph), sides(without));
  EXPECT_TRUE(is_consistent(graph.graph()));
}

TEST(PairOddFaces, JoinsTwoTriangles) {
  const TriMesh mesh = grid_mesh({steps(6), steps(6)});
  const PolygonGraph whole =
      cells_of(mesh, [](const Vec3& a, const Vec3& b) { return !is_diagonal(a, b); });
  PolygonGraph triangles = cells_of(mesh, [](const Vec3& a, const Vec3& b) {
    const Vec3 middle = (a + b) / 2;
    return !is_diagonal(a, b) || (middle - Vec3(2.5, 2.5, 0)).norm() < 0.1;
  });
  ASSERT_EQ(sides(triangles)[3], 2);
  EXPECT_EQ(pair_odd_faces(triangles, unit_length, 1).divided_patches, 1);
  EXPECT_EQ(sides(triangles), sides(whole));
}

TEST(PairOddFaces, MakesNoNodeOfTwoEdgesBetweenTrianglesAtACrease) {
  const TriMesh mesh = grid_mesh({steps(6), steps(6)});
  PolygonGraph graph = cells_of(
      mesh, [](const Vec3& a, const Vec3& b) { return !is_diagonal(a, b); },
      [](const Vec3& a, const Vec3& b) {
        return is_diagonal(a, b) && ((a + b) / 2 - Vec3(2.5, 2.5, 0)).norm() < 0.1;
      });
  ASSERT_EQ(sides(graph)[3], 2);
  pair_odd_faces(graph, unit_length, 1);
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d) || graph.kind(d) != EdgeKind::feature) continue;
    EXPECT_GT(graph.degree(d), 2);
  }
}

bool has_double_edge(const PolygonGraph& graph) {
  std::set<std::pair<Index, Index>> seen;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    if (!seen.emplace(graph.graph().from(d), graph.graph().to(d)).second) return true;
  }
  return false;
}

TEST(PairOddFaces, NeverJoinsTwoNodesTwice) {
  // Two pentagons at a common edge a b, with the same node x across from it; two quads between them
  // close the surface.
  PolyMesh soup;
  soup.positions = {{-1, 0, 0}, {1, 0, 0},   {0, 3, 0}, {-1, 2, 1},
                    {1, 2, 1},  {-1, 2, -1}, {1, 2, -1}};
  const Index a = 0, b = 1, x = 2, p = 3, q = 4, r = 5, s = 6;
  for (const auto& triangle : std::vector<std::array<Index, 3>>{{a, b, q},
                                                                {a, q, x},
                                                                {a, x, p},
                                                                {b, a, r},
                                                                {b, r, x},
                                                                {b, x, s},
                                                                {p, x, r},
                                                                {p, r, a},
                                                                {q, b, s},
                                                                {q, s, x}}) {
    soup.add_face(triangle);
  }
  const TriMesh mesh = support::plain_tri_mesh(soup);
  const std::set<std::pair<Index, Index>> inner = {{a, q}, {a, x}, {b, r}, {b, x}, {p, r}, {q, s}};
  const auto vertex = [&](const Vec3& at) {
    return static_cast<Index>(std::min_element(soup.positions.begin(), soup.positions.end(),
                                               [&](const Vec3& one, const Vec3& two) {
                                                 return (one - at).norm() < (two - at).norm();
                                               }) -
                              soup.positions.begin());
  };
  PolygonGraph graph = cells_of(mesh, [&](const Vec3& from, const Vec3& to) {
    return !inner.contains(std::minmax(vertex(from), vertex(to)));
  });
  for (Index d = 0, end = graph.graph().dart_count(); d < end; d += 2) {
    const bool beside_x = vertex(graph.position(graph.graph().from(d)) + mesh.origin) == x ||
                          vertex(graph.position(graph.graph().to(d)) + mesh.origin) == x;
    if (beside_x) graph.split(d, 0.5);  // p to s again, which were no ends of edges
  }
  ASSERT_EQ(sides(graph), (std::map<std::size_t, int>{{4, 2}, {5, 2}}));
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    const Index across = DartGraph::opposite(d);
    const bool both = graph.cell(d).size() == 5 && graph.cell(across).size() == 5;
    EXPECT_EQ(can_halve(graph, d), !both);
  }
  PolygonGraph pure = graph;
  pair_odd_faces(
      graph, [](Index) { return 0.1; }, 100);
  EXPECT_FALSE(has_double_edge(graph));
  join_odd_faces(pure);
  EXPECT_EQ(sides(pure).count(4), sides(pure).size());
  EXPECT_FALSE(has_double_edge(pure));
}

TEST(PairOddFaces, LeavesAllAsItIsForNoPrice) {
  const TriMesh mesh = grid_mesh({steps(6), steps(6)});
  const auto all = [](const Vec3&, const Vec3&) { return true; };
  PolygonGraph graph = cells_of(mesh, all);
  const auto before = sides(graph);
  pair_odd_faces(graph, unit_length, 0);
  EXPECT_EQ(sides(graph), before);
}

TEST(JoinOddFaces, TurnsWhereTwoPentagonsDoNotFaceEachOther) {
  const TriMesh mesh = grid_mesh({steps(8), steps(8)});
  PolygonGraph graph =
      cells_of(mesh, [](const Vec3& a, const Vec3& b) { return !is_diagonal(a, b); });
  const auto halve = [&](double x, double y) {
    for (Index d = 0; d < graph.graph().dart_count(); ++d) {
      if (!graph.graph().is_alive(d)) continue;
      const Vec3 middle =
          0.5 * (graph.position(graph.graph().from(d)) + graph.position(graph.graph().to(d))) +
          mesh.origin;
      if ((middle - Vec3(x, y, 0)).norm() > 1e-9) continue;
      graph.split(d, 0.5);
      return;
    }
  };
  halve(2.5, 0);  // on the boundary
  halve(7, 4.5);
  ASSERT_EQ(sides(graph)[5], 2);
  const auto boundary = [&] {
    int edges = 0;
    for (Index d = 0; d < graph.graph().dart_count(); ++d) {
      if (graph.graph().is_alive(d) && graph.is_outer(d)) ++edges;
    }
    return edges;
  };
  const int before = boundary();
  EXPECT_GE(join_odd_faces(graph), 1);
  EXPECT_EQ(sides(graph).count(4), sides(graph).size()) << "only quads";
  EXPECT_EQ(boundary() % 2, before % 2) << "a disk of quads has an even boundary";
  EXPECT_TRUE(is_consistent(graph.graph()));
}

struct Share {
  Index quads = 0;
  Index concave = 0;
  double of_quads = 0;
};

Share share_of_quads(const QuadMesh& quads) {
  Share share;
  const PolyMesh& mesh = quads.mesh;
  share.quads = analyse(mesh).quads;
  share.of_quads = static_cast<double>(share.quads) / mesh.face_count();
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_concave_face(mesh.positions, mesh.face(f))) ++share.concave;
  }
  return share;
}

class PairedSurfaces : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Samples, PairedSurfaces,
                         ::testing::Values(SampleKind::torus, SampleKind::ellipsoid,
                                           SampleKind::saddle, SampleKind::part),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

/// Positions of vertices on feature and boundary lines, relative to the origin of the mesh.
std::set<std::array<double, 3>> on_features(const support::Prepared& prepared,
                                            const QuadMesh& quads) {
  std::set<std::array<double, 3>> found;
  for (std::size_t v = 0; v < quads.mesh.positions.size(); ++v) {
    const Index face = quads.provenance.face[v];
    for (int i = 0; i < 3; ++i) {
      const Index opposite = 3 * face + (i + 1) % 3;
      if (quads.provenance.barycentric[v][i] != 0 || !prepared.mesh.is_barrier(opposite)) continue;
      const Vec3& p = quads.mesh.positions[v];
      found.insert({p.x(), p.y(), p.z()});
    }
  }
  return found;
}

TEST_P(PairedSurfaces, HaveFewOddFacesNoMoreConcaveOnesAndTheirFeatures) {
  SampleOptions sample;
  sample.faces = 8000;
  sample.jitter = 0.5;
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample));
  TraceOptions options;
  options.vertices = 700;
  options.spacing_scale = 1;
  const LineSet lines = support::trace(prepared, options);
  const QuadMesh plain = support::mesh(prepared, lines, {.odd_price = 0});
  const QuadMesh paired = support::mesh(prepared, lines, {.odd_price = 1});
  const Share before = share_of_quads(plain);
  const Share after = share_of_quads(paired);
  EXPECT_LE(1 - after.of_quads, 0.4 * (1 - before.of_quads));
  EXPECT_GE(after.of_quads, 0.96);
  EXPECT_LE(after.concave, before.concave);
  const QuadMesh pure = support::mesh(prepared, lines, {.pure_quads = true});
  EXPECT_EQ(share_of_quads(pure).of_quads, 1);
  EXPECT_LE(pure.mesh.vertex_count(), 1.15 * paired.mesh.vertex_count());
  const auto features = on_features(prepared, paired);
  for (const auto& p : on_features(prepared, plain)) {
    EXPECT_TRUE(features.contains(p)) << "a vertex of a feature line is gone";
  }
}

}  // namespace
}  // namespace strake
