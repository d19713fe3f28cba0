#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "tests/support/mesh_support.h"

/// Surfaces over the unit square, with results of a few square faces whose vertices lie on them.
namespace strake::support {

struct Case {
  TriMesh mesh;
  QuadMesh quads;
};

/// z = height(x, y), as n x n squares of two triangles, and a result of cells x cells faces.
/// \pre cells divides n
template <class Height>
Case grid(Index n, Index cells, const Height& height) {
  PolyMesh soup;
  for (Index j = 0; j <= n; ++j) {
    for (Index i = 0; i <= n; ++i) {
      const double x = double(i) / n;
      const double y = double(j) / n;
      soup.positions.emplace_back(x, y, height(x, y));
    }
  }
  const auto vertex = [](Index i, Index j, Index count) { return j * (count + 1) + i; };
  for (Index j = 0; j < n; ++j) {
    for (Index i = 0; i < n; ++i) {
      const Index a = vertex(i, j, n);
      const Index b = vertex(i + 1, j, n);
      const Index c = vertex(i + 1, j + 1, n);
      const Index d = vertex(i, j + 1, n);
      soup.add_face(std::array<Index, 3>{a, b, c});
      soup.add_face(std::array<Index, 3>{a, c, d});
    }
  }
  Case result;
  result.mesh = support::plain_tri_mesh(soup);
  const Index step = n / cells;
  for (Index j = 0; j <= cells; ++j) {
    for (Index i = 0; i <= cells; ++i) {
      const Index v = vertex(i * step, j * step, n);
      const Index h = result.mesh.vertex_out[v];
      std::array<double, 3> barycentric = {0, 0, 0};
      barycentric[h % 3] = 1;
      result.quads.mesh.positions.push_back(soup.positions[v]);
      result.quads.provenance.face.push_back(TriMesh::face_of(h));
      result.quads.provenance.barycentric.push_back(barycentric);
      result.quads.provenance.lines.push_back({kNone, kNone});
    }
  }
  for (Index j = 0; j < cells; ++j) {
    for (Index i = 0; i < cells; ++i) {
      result.quads.mesh.add_face(std::array<Index, 4>{vertex(i, j, cells), vertex(i + 1, j, cells),
                                                      vertex(i + 1, j + 1, cells),
                                                      vertex(i, j + 1, cells)});
    }
  }
  return result;
}

/// One face over z = k x (1 - x) / 2: bent along x only.
inline Case bent_strip(double k) {
  return grid(64, 1, [&](double x, double) { return k * x * (1 - x) / 2; });
}

/// Faces as the result, and triangles between their vertices as the surface.
/// \param cut  of all faces
Case on_triangles(const PolyMesh& faces, const FaceTriangles& cut);

/// A pentagon that rounding alone decides how to cut: a corner of it lies, seen along its normal,
/// on the straight way between two others, but 0.6 off it.
PolyMesh undecided_pentagon();

}  // namespace strake::support
