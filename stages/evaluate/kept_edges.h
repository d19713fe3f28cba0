#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/poly_edges.h"

namespace strake::evaluation {

/// Reports "features.*" and "boundary.*": the length of the reference's feature and boundary edges
/// and the share of it that the candidate keeps.
///
/// A point of such an edge counts as kept where an edge of the candidate (for the boundary: a
/// boundary edge) runs within 30 degrees of its direction and passes within 0.1 % of the diagonal
/// of the reference. An edge with both ends on such lines is the chord of an arc, and keeps what is
/// within 5 % of its own length beside it. Points are taken at most 0.05 % of the diagonal apart.
///
/// \param candidate  in the reference's frame
void report_kept_edges(const TriMesh& reference, const PolyMesh& candidate, const PolyEdges& edges,
                       Report& report);

}  // namespace strake::evaluation
