#pragma once

#include <cstdint>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/core/types.h"

namespace strake::support {

/// A TriMesh with the vertices and faces of a triangle mesh in their order, and no feature edges.
/// \pre an oriented manifold of triangles without unused vertices
TriMesh plain_tri_mesh(const PolyMesh& mesh);

/// The mesh with every position p replaced by linear * p + shift. A reflection turns the faces, so
/// that they stay oriented outwards.
PolyMesh transformed(const PolyMesh& mesh, const Mat3& linear, const Vec3& shift = Vec3::Zero());

/// Both meshes side by side, with vertices of their own.
PolyMesh together(const PolyMesh& a, const PolyMesh& b);

/// A rotation that has nothing to do with the axes.
Mat3 oblique_rotation();

/// The reflection in a plane that has nothing to do with the axes.
Mat3 oblique_reflection();

struct PermutedMesh {
  PolyMesh mesh;
  std::vector<Index> old_vertex;  ///< [V] vertex of the original
  std::vector<Index> old_face;    ///< [F] face of the original
};

/// The same mesh with vertices and faces in random order, and each face begun at a random corner.
PermutedMesh permuted(const PolyMesh& mesh, std::uint64_t seed);

/// The dihedral angle at half-edge h, radians in (-pi, pi]; positive where convex.
/// \pre not a boundary half-edge
double dihedral_angle(const TriMesh& mesh, Index h);

/// Mean edge length.
double mean_edge_length(const TriMesh& mesh);

/// A third of the area of the faces around each vertex. [V]
std::vector<double> vertex_areas(const TriMesh& mesh);

/// The slope of the straight line fitted to log(error) over log(size): the order of convergence.
double observed_order(const std::vector<double>& sizes, const std::vector<double>& errors);

}  // namespace strake::support
