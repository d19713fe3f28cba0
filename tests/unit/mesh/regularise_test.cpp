#include "stages/mesh/regularise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/chain.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

constexpr Index kColumns = 7;

Index grid_vertex(Index x, Index y) { return y * kColumns + x; }

/// A grid of unit squares in the plane.
PolyMesh square_grid() {
  PolyMesh grid;
  for (Index y = 0; y < kColumns; ++y) {
    for (Index x = 0; x < kColumns; ++x) grid.positions.emplace_back(x, y, 0);
  }
  for (Index y = 0; y + 1 < kColumns; ++y) {
    for (Index x = 0; x + 1 < kColumns; ++x) {
      grid.add_face(std::array<Index, 4>{grid_vertex(x, y), grid_vertex(x + 1, y),
                                         grid_vertex(x + 1, y + 1), grid_vertex(x, y + 1)});
    }
  }
  return grid;
}

/// The mesh without some of its faces, and with others.
PolyMesh replaced(const PolyMesh& mesh, const std::set<Index>& removed,
                  const std::vector<std::vector<Index>>& added) {
  PolyMesh result;
  result.positions = mesh.positions;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (!removed.contains(f)) result.add_face(mesh.face(f));
  }
  for (const std::vector<Index>& face : added) result.add_face(face);
  return result;
}

/// The grid with the vertex in its middle opened to a quad: two vertices of valence 3 across from
/// each other, and two of valence 5 beside them.
PolyMesh opened_grid() {
  PolyMesh grid = square_grid();
  const auto upper = static_cast<Index>(grid.positions.size());
  const Index lower = grid_vertex(3, 3);
  grid.positions[lower] = {3, 2.7, 0};
  grid.positions.emplace_back(3, 3.3, 0);
  const auto square = [](Index x, Index y) { return y * (kColumns - 1) + x; };
  return replaced(grid, {square(2, 3), square(3, 3)},
                  {{grid_vertex(2, 3), upper, grid_vertex(3, 4), grid_vertex(2, 4)},
                   {upper, grid_vertex(4, 3), grid_vertex(4, 4), grid_vertex(3, 4)},
                   {grid_vertex(2, 3), lower, grid_vertex(4, 3), upper}});
}

/// The grid with two squares side by side divided along another diagonal of their hexagon.
PolyMesh turned_grid() {
  PolyMesh grid = square_grid();
  grid.positions[grid_vertex(3, 2)].y() = 1.9;
  grid.positions[grid_vertex(3, 3)].y() = 3.1;
  const auto square = [](Index x, Index y) { return y * (kColumns - 1) + x; };
  return replaced(grid, {square(2, 2), square(3, 2)},
                  {{grid_vertex(2, 2), grid_vertex(3, 2), grid_vertex(4, 2), grid_vertex(4, 3)},
                   {grid_vertex(2, 2), grid_vertex(4, 3), grid_vertex(3, 3), grid_vertex(2, 3)}});
}

TriMesh triangles_of(const PolyMesh& quads) {
  PolyMesh soup;
  soup.positions = quads.positions;
  for (Index f = 0; f < quads.face_count(); ++f) {
    const auto q = quads.face(f);
    soup.add_face(std::array<Index, 3>{q[0], q[1], q[3]});
    soup.add_face(std::array<Index, 3>{q[1], q[2], q[3]});
  }
  TriMesh mesh = support::plain_tri_mesh(soup);
  for (const auto& [x, y] : {std::pair{0, 0}, {0, 6}, {6, 0}, {6, 6}}) {
    mesh.is_corner[grid_vertex(x, y)] = 1;
  }
  return mesh;
}

using Sides = std::set<std::pair<Index, Index>>;

/// The quads of a planar mesh as cells between lines, some of them features. The triangles must
/// outlive them.
PolygonGraph cells_of(const PolyMesh& quads, const TriMesh& mesh, const Sides& crease = {}) {
  Sides sides;
  for (Index f = 0; f < quads.face_count(); ++f) {
    const auto q = quads.face(f);
    for (std::size_t i = 0; i < q.size(); ++i) {
      sides.insert(std::minmax(q[i], q[(i + 1) % q.size()]));
    }
  }
  Overlay overlay = overlay_of(mesh);
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    if (overlay.kind[e] != EdgeKind::surface) continue;
    const Index a = overlay.nodes[overlay.graph.from(2 * e)].vertex;
    const Index b = overlay.nodes[overlay.graph.to(2 * e)].vertex;
    if (sides.contains(std::minmax(a, b))) overlay.kind[e] = EdgeKind::line;
    if (crease.contains(std::minmax(a, b))) overlay.kind[e] = EdgeKind::feature;
  }
  reduce_to_lines(overlay);
  return {mesh, overlay};
}

/// Degrees of the nodes inside, each as often as it is there.
std::multiset<Index> irregular_degrees(const PolygonGraph& graph) {
  std::multiset<Index> found;
  std::set<Index> seen;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d) || !seen.insert(graph.graph().from(d)).second) continue;
    const Index degree = graph.degree(d);
    if (irregularity(graph, d, degree) != 0) found.insert(degree);
  }
  return found;
}

TEST(Regularise, ClosesAQuadBetweenTwoNodesOfThreeEdges) {
  const PolyMesh quads = opened_grid();
  const TriMesh mesh = triangles_of(quads);
  PolygonGraph graph = cells_of(quads, mesh);
  ASSERT_EQ(irregular_degrees(graph), (std::multiset<Index>{3, 3, 5, 5}));
  const RegularisingCounts counts = regularise(graph, 1);
  EXPECT_EQ(counts.closed_quads, 1);
  EXPECT_EQ(counts.divided_patches, 0);
  EXPECT_TRUE(irregular_degrees(graph).empty());
  EXPECT_TRUE(is_consistent(graph.graph()));
  EXPECT_EQ(count(graph.graph()).nodes, kColumns * kColumns);
  bool is_in_the_middle = false;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    const Vec3 p = graph.position(graph.graph().from(d)) + mesh.origin;
    is_in_the_middle = is_in_the_middle || (p - Vec3(3, 3, 0)).norm() < 1e-12;
  }
  EXPECT_TRUE(is_in_the_middle);
}

TEST(Regularise, DividesTwoQuadsAnew) {
  const PolyMesh quads = turned_grid();
  const TriMesh mesh = triangles_of(quads);
  PolygonGraph graph = cells_of(quads, mesh);
  ASSERT_EQ(irregular_degrees(graph), (std::multiset<Index>{3, 3, 5, 5}));
  const RegularisingCounts counts = regularise(graph, 1);
  EXPECT_EQ(counts.divided_patches, 1);
  EXPECT_EQ(counts.closed_quads, 0);
  EXPECT_TRUE(irregular_degrees(graph).empty());
  EXPECT_TRUE(is_consistent(graph.graph()));
  EXPECT_EQ(count(graph.graph()).nodes, kColumns * kColumns);
}

TEST(Regularise, LeavesWhatIsRegularAndWhatCostsNothing) {
  const PolyMesh regular = square_grid();
  const TriMesh squares = triangles_of(regular);
  PolygonGraph graph = cells_of(regular, squares);
  RegularisingCounts counts = regularise(graph, 1);
  EXPECT_EQ(counts.closed_quads + counts.divided_patches, 0);
  const PolyMesh irregular = opened_grid();
  const TriMesh opened = triangles_of(irregular);
  PolygonGraph left = cells_of(irregular, opened);
  counts = regularise(left, 0);
  EXPECT_EQ(counts.closed_quads + counts.divided_patches, 0);
  EXPECT_EQ(irregular_degrees(left).size(), 4);
}

TEST(Regularise, MergesIntoANodeOfAFeature) {
  const PolyMesh quads = opened_grid();
  const TriMesh mesh = triangles_of(quads);
  const Index lower = grid_vertex(3, 3);
  PolygonGraph graph = cells_of(
      quads, mesh, {std::minmax(grid_vertex(2, 3), lower), std::minmax(lower, grid_vertex(4, 3))});
  EXPECT_EQ(regularise(graph, 1).closed_quads, 1);
  EXPECT_TRUE(irregular_degrees(graph).empty());
  bool is_there = false;
  int crease_darts = 0;
  for (Index d = 0; d < graph.graph().dart_count(); ++d) {
    if (!graph.graph().is_alive(d)) continue;
    is_there = is_there || graph.position(graph.graph().from(d)) == mesh.positions[lower];
    if (graph.kind(d) == EdgeKind::feature) ++crease_darts;
  }
  EXPECT_TRUE(is_there) << "it has moved";
  EXPECT_EQ(crease_darts, 4);
}

TEST(Regularise, LeavesNodesOfTwoFeaturesApart) {
  const PolyMesh quads = opened_grid();
  const TriMesh mesh = triangles_of(quads);
  const auto upper = static_cast<Index>(quads.positions.size()) - 1;
  PolygonGraph graph = cells_of(
      quads, mesh,
      {std::minmax(grid_vertex(3, 2), grid_vertex(3, 3)), std::minmax(upper, grid_vertex(3, 4))});
  const Index nodes = count(graph.graph()).nodes;
  EXPECT_EQ(regularise(graph, 1).closed_quads, 0);
  EXPECT_EQ(count(graph.graph()).nodes, nodes);
}

struct Regularity {
  double of_four = 0;  ///< share of the inner vertices with four edges
  Index quads = 0;
  Index concave = 0;
};

Regularity regularity_of(const PolyMesh& mesh) {
  std::set<std::pair<Index, Index>> darts;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      darts.emplace(face[i], face[(i + 1) % face.size()]);
    }
  }
  std::vector<int> valence(mesh.positions.size(), 0);
  std::vector<char> is_inner(mesh.positions.size(), 1);
  for (const auto& [a, b] : darts) {
    ++valence[a];
    if (!darts.contains({b, a})) is_inner[a] = is_inner[b] = 0;
  }
  Index inner = 0;
  Index four = 0;
  for (std::size_t v = 0; v < valence.size(); ++v) {
    if (is_inner[v] == 0) continue;
    ++inner;
    if (valence[v] == 4) ++four;
  }
  Regularity found{static_cast<double>(four) / inner, analyse(mesh).quads, 0};
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_concave_face(mesh.positions, mesh.face(f))) ++found.concave;
  }
  return found;
}

class RegularisedSurfaces : public ::testing::TestWithParam<SampleKind> {};

INSTANTIATE_TEST_SUITE_P(Samples, RegularisedSurfaces,
                         ::testing::Values(SampleKind::saddle, SampleKind::part),
                         [](const auto& test) {
                           return sample_names()[static_cast<std::size_t>(test.param)];
                         });

TEST_P(RegularisedSurfaces, HaveMoreVerticesOfFourEdgesAndNoOtherFaces) {
  SampleOptions sample;
  sample.faces = 8000;
  sample.jitter = 0.5;
  const support::Prepared prepared = support::prepare(make_sample(GetParam(), sample));
  TraceOptions options;
  options.vertices = 700;
  const LineSet lines = support::trace(prepared, options);
  const QuadMesh plain = support::mesh(prepared, lines, {.valence_price = 0});
  const QuadMesh regular = support::mesh(prepared, lines, {.valence_price = 1});
  const Regularity before = regularity_of(plain.mesh);
  const Regularity after = regularity_of(regular.mesh);
  EXPECT_LE(1 - after.of_four, 0.95 * (1 - before.of_four));
  EXPECT_LE(after.concave, before.concave);
  EXPECT_EQ(regular.mesh.face_count() - after.quads, plain.mesh.face_count() - before.quads);
  const QuadMesh pure = support::mesh(prepared, lines, {.pure_quads = true});
  EXPECT_EQ(regularity_of(pure.mesh).quads, pure.mesh.face_count());
}

}  // namespace
}  // namespace strake
