#pragma once

#include <array>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"

namespace strake::evaluation {

/// Reports "faces.*", "angles.*", "shape.*" and "edges.*": the form of a mesh's faces.
///
/// A face is degenerate where its area is at most 1e-6 of its longest edge squared; it is then left
/// out of all other figures of its shape. Corner angles are reflex (above 180) where a corner turns
/// against the face's Newell normal. `shape.aspect` is longest edge x perimeter / (4 area), over a
/// further sqrt(3) for triangles: 1 for the square and the equilateral triangle. `shape.stretch` is
/// the ratio of the mean lengths of opposite pairs of edges of a quad. `shape.jacobian` is the
/// least sine of a quad's corners along its normal. `shape.off_plane` is the largest distance of a
/// corner to the plane through the face's middle, over the root of its area.
/// `angles.face_share_above_10_deg` is the share of faces whose smallest angle is above 10 degrees.
/// `shape.self_intersecting_pairs` counts the pairs of faces that meet anywhere but in the corners
/// and edges they share.
/// \return these pairs
std::vector<std::array<Index, 2>> report_shape(const PolyMesh& mesh, const PolyTopology& topology,
                                               const FaceTriangles& triangles,
                                               const PolyEdges& edges, Report& report);

/// Reports "valence.*": edges at the vertices that are not on a boundary or non-manifold edge.
/// A T-joint is such a vertex of valence 3 with a corner of more than 160 degrees.
void report_valence(const PolyMesh& mesh, const PolyEdges& edges, Report& report);

}  // namespace strake::evaluation
