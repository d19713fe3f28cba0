#pragma once

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Divides edges that are longer than `longest`, but for those between needles, and the faces
/// beside them, until none is or there would be more than `most_vertices`. The surface stays what
/// it is, and so do its features.
///
/// Fields live on vertices: the one direction at the tip of a cone that is a fan of triangles, or
/// in the middle of a disk that has vertices along its rim only, says nothing. [MK04 §3.2]
///
/// So are edges that lead from the end of a feature to that of another one straight ahead, as those
/// of windows in a row: lines go from one to the other, and none goes along an edge.
/// \param longest        model units, above 0; from the diagonal on nothing is divided
/// \param most_vertices  longer edges come first, so what is left undivided is about equally long
/// \pre build_topology has run
/// \return number of new vertices; their `source_vertex` is kNone
Index divide_long_edges(TriMesh& mesh, double longest, Index most_vertices);

}  // namespace strake::import
