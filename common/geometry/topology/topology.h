#pragma once

#include <string>

#include "common/core/tri_mesh.h"

namespace strake {

/// Fills `twin` and `vertex_out` from `faces`, and sizes `is_feature` and `is_corner` (all 0) where
/// they do not fit the mesh.
///
/// `vertex_out` of a boundary vertex is the half-edge without a twin, the clockwise-most one, so
/// that `rotate_ccw` visits the whole fan from there; elsewhere it is the one of lowest index.
/// \pre indices in range, no face repeats a corner
/// \throw Error(internal) where an edge has more than two faces, or two of equal direction
/// Cost O(V + F).
void build_topology(TriMesh& mesh);

/// Fills `face_wedges` and `wedge_vertex` from `is_feature` and the boundary.
///
/// The wedges of a vertex are numbered in a row, counter-clockwise, and the vertices in order:
/// without features wedge w is vertex w.
/// \pre build_topology has run, every vertex has one fan
void build_wedges(TriMesh& mesh);

/// Checks every invariant that TriMesh states, and that all arrays fit together.
/// \throw Error(internal) naming the first that is violated
void validate(const TriMesh& mesh);

struct Census {
  Index components = 0;
  Index boundary_loops = 0;
  Index euler_characteristic = 0;
  Index genus = 0;  ///< summed over the components
};

/// Counts what a continuous deformation does not change.
/// \pre build_topology has run
Census census(const TriMesh& mesh);

/// The component of each face, numbered in order of the first face.
/// \return [F] in [0, components)
std::vector<Index> face_components(const TriMesh& mesh);

/// The diagonal of the bounding box of each component, model units.
/// \param component  [F] as `face_components` gives it
std::vector<double> component_extents(const TriMesh& mesh, const std::vector<Index>& component);

/// 32 hexadecimal digits that identify the mesh: XXH3-128 of origin, positions, faces, feature and
/// corner flags, and the id of the mesh it is a coarser one of.
std::string content_id(const TriMesh& mesh);

}  // namespace strake
