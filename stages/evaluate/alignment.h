#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "stages/evaluate/measured_surface.h"

namespace strake::evaluation {

/// How one edge of a candidate lies to the directions of a field at its midpoint, each angle folded
/// into 0 to 45 degrees; negative where it is not judged.
struct EdgeAngles {
  double length = 0;
  double principal_deg = -1;
  double cross_deg = -1;
};

/// [E] the angles that `report_alignment` reports on, by the same rules.
std::vector<EdgeAngles> measure_edge_angles(const TriMesh& reference,
                                            const MeasuredSurface& reference_surface,
                                            const PrincipalField& field, const PolyMesh& candidate,
                                            const PolyEdges& edges);

/// Reports "alignment.*": the angle, folded into 0 to 45 degrees, between each edge of the
/// candidate and the nearest direction of a field at the edge's midpoint, weighted with edge
/// length. Random directions give 22.5.
///
/// `alignment.*` is against the principal directions and judges an edge only where they mean
/// something: |k_max - k_min| > 0.5 (|k_max| + |k_min|), |k_max| x diagonal > 2, and a face
/// confidence of at least cos 30 degrees. `alignment.quads.*` is the same for the edges of quads,
/// `alignment.cross.*` is against the field's cross and judges every edge. Edges that stand off the
/// surface by more than 70 degrees are not judged.
/// \param reference_surface  triangles are the reference's faces
/// \param candidate          in the reference's frame
/// \throw PreconditionError where the field does not fit the reference
void report_alignment(const TriMesh& reference, const MeasuredSurface& reference_surface,
                      const PrincipalField& field, const PolyMesh& candidate,
                      const PolyEdges& edges, Report& report);

}  // namespace strake::evaluation
