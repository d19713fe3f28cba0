#pragma once

#include <cstddef>
#include <functional>
#include <set>
#include <vector>

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

using Height = std::function<double(double, double)>;

/// Sheets z = height(x, y), each as n x n squares of two triangles, and a result of cells x cells
/// faces of each.
/// \pre cells divides n
Case sheets(Index n, Index cells, const std::vector<Height>& heights);

/// One such sheet.
inline Case grid(Index n, Index cells, const Height& height) { return sheets(n, cells, {height}); }

/// One face over z = k x (1 - x) / 2: bent along x only.
inline Case bent_strip(double k) {
  return grid(64, 1, [&](double x, double) { return k * x * (1 - x) / 2; });
}

/// A flat sheet of n x n squares with n teeth of this height on its upper side, each a triangle on
/// the side of a square, and a result of cells x cells faces under them. Face 2 n^2 + i is tooth i.
/// \pre cells divides n
Case toothed_sheet(Index n, Index cells, double height);

/// Faces as the result, and triangles between their vertices as the surface.
/// \param cut  of all faces
Case on_triangles(const PolyMesh& faces, const FaceTriangles& cut);

/// A pentagon that rounding alone decides how to cut: a corner of it lies, seen along its normal,
/// on the straight way between two others, but 0.6 off it.
PolyMesh undecided_pentagon();

/// Of all faces, their numbers of corners.
std::multiset<std::size_t> sides(const PolyMesh& mesh);
/// Of a flat result, seen from above.
double total_area(const PolyMesh& mesh);

}  // namespace strake::support
