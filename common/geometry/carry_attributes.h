#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// What a remeshed surface carries, from the surface that it lies on.
///
/// - Colours are interpolated at the foot of each vertex.
/// - Texture coordinates are interpolated for each corner of a face, in the triangle on which the
///   corner lies: where the vertex is on an edge or vertex of the surface, that is the one on the
///   face's side, by the direction of the corner's bisector. So both sides of a seam keep theirs.
/// - A face has the label of most of its corners; those count that leave no doubt, because all
///   triangles there have the same, and where there are none the triangles on the face's side. Of
///   equals it is the one below the middle of the face.
///
/// A face that lies across a seam or a border of labels cannot be right; lines of the trace stage
/// run along these where they are feature edges.
///
/// \param places  of the vertices of `result`, on `mesh`
Attributes carry_attributes(const TriMesh& mesh, const PolyMesh& result,
                            const VertexProvenance& places);

}  // namespace strake
