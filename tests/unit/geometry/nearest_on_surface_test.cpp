#include "common/geometry/nearest_on_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "common/geometry/samples/samples.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A result of which only the vertices count: at these vertices of the mesh.
QuadMesh vertices_at(const TriMesh& mesh, const std::vector<Index>& vertices) {
  QuadMesh quads;
  for (const Index v : vertices) {
    const Index corner = mesh.vertex_out[v];
    std::array<double, 3> barycentric = {0, 0, 0};
    barycentric[corner % 3] = 1;
    quads.mesh.positions.push_back(mesh.positions[v] + mesh.origin);
    quads.provenance.face.push_back(TriMesh::face_of(corner));
    quads.provenance.barycentric.push_back(barycentric);
  }
  return quads;
}

Vec3 middle(const TriMesh& mesh, Index face) {
  const auto& [a, b, c] = mesh.faces[face];
  return (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3;
}

/// Two sheets, a tenth apart, which are joined at x = 10. Vertices by columns of two; the first 11
/// columns are the lower sheet, from x = 0 on, the others the upper one, back to x = 0.
TriMesh folded_strip() {
  PolyMesh mesh;
  for (Index i = 0; i < 22; ++i) {
    const double x = i < 11 ? i : 21 - i;
    for (const double y : {0.0, 1.0}) mesh.positions.emplace_back(x, y, i < 11 ? 0 : 0.1);
    if (i == 0) continue;
    const Index v = 2 * i;
    mesh.add_face(std::array<Index, 3>{v - 2, v, v + 1});
    mesh.add_face(std::array<Index, 3>{v - 2, v + 1, v - 1});
  }
  return support::plain_tri_mesh(mesh);
}

TEST(NearestOnSurface, IsNotAcrossAFold) {
  const TriMesh mesh = folded_strip();
  const Index below = 2 * 2;         // at x = 2
  const Index above = 2 * (21 - 6);  // at x = 6
  const QuadMesh quads = vertices_at(mesh, {above, below});
  const NearestOnSurface nearest(mesh, quads);
  const Index face = 2 * 5;  // from x = 5 to 6, below
  EXPECT_LT((middle(mesh, face) - mesh.positions[above]).norm(),
            (middle(mesh, face) - mesh.positions[below]).norm());
  EXPECT_EQ(nearest.vertex(face, middle(mesh, face)), 1);
}

TEST(NearestOnSurface, IsNoneWhereAPieceHasNone) {
  PolyMesh pieces;
  pieces.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  pieces.add_face(std::array<Index, 3>{0, 1, 2});
  pieces.add_face(std::array<Index, 3>{3, 4, 5});
  const TriMesh mesh = support::plain_tri_mesh(pieces);
  const QuadMesh quads = vertices_at(mesh, {0});
  const NearestOnSurface nearest(mesh, quads);
  EXPECT_EQ(nearest.vertex(0, middle(mesh, 0)), 0);
  EXPECT_EQ(nearest.vertex(1, middle(mesh, 1)), kNone);
}

/// [V] length of the shortest way along edges to any of these vertices.
std::vector<double> ways_along_edges(const TriMesh& mesh, const std::vector<Index>& ends) {
  std::vector<double> way(mesh.positions.size(), std::numeric_limits<double>::infinity());
  for (const Index v : ends) way[v] = 0;
  for (bool changed = true; changed;) {
    changed = false;
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index a = mesh.from(h);
      const Index b = mesh.to(h);
      const double there = way[a] + (mesh.positions[b] - mesh.positions[a]).norm();
      if (!(there < way[b])) continue;
      way[b] = there;
      changed = true;
    }
  }
  return way;
}

TEST(NearestOnSurface, IsTheNearestOfAll) {
  SampleOptions options;
  options.faces = 2000;
  const TriMesh mesh = support::plain_tri_mesh(make_sample(SampleKind::torus, options));
  std::vector<Index> ends;
  for (Index v = 0; v < mesh.vertex_count(); v += 37) ends.push_back(v);
  const QuadMesh quads = vertices_at(mesh, ends);
  const NearestOnSurface nearest(mesh, quads);
  const std::vector<double> least = ways_along_edges(mesh, ends);
  std::vector<std::vector<double>> ways;
  int compared = 0;
  for (const Index end : ends) ways.push_back(ways_along_edges(mesh, {end}));
  for (Index f = 0; f < mesh.face_count(); f += 11) {
    // Beside a foot the way straight through the faces may be shorter than any along edges.
    const auto has_foot = [&](Index face) {
      return std::ranges::count(quads.provenance.face, face) > 0;
    };
    if (has_foot(f) || has_foot(TriMesh::face_of(mesh.twin[3 * f])) ||
        has_foot(TriMesh::face_of(mesh.twin[3 * f + 1])) ||
        has_foot(TriMesh::face_of(mesh.twin[3 * f + 2]))) {
      continue;
    }
    const Vec3 place = middle(mesh, f);
    const auto way_over_corners = [&](const std::vector<double>& way) {
      double length = std::numeric_limits<double>::infinity();
      for (const Index v : mesh.faces[f]) {
        length = std::min(length, way[v] + (mesh.positions[v] - place).norm());
      }
      return length;
    };
    const Index found = nearest.vertex(f, place);
    ASSERT_NE(found, kNone);
    EXPECT_NEAR(way_over_corners(ways[found]), way_over_corners(least), 1e-12) << f;
    ++compared;
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace strake
