#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "stages/smooth/guide_pull.h"
#include "stages/smooth/wedge_graph.h"

namespace strake {

/// Fills `field.cross` with the smoothest 4-symmetric direction field that holds to the principal
/// directions where they are reliable and to feature and boundary lines.
///
/// Minimises the Dirichlet energy of cross_power(cross) plus, at every wedge, `stiffness` *
/// confidence^2 * (k_max - k_min) / diagonal * area times a loss of the angle to the principal
/// direction: dimensionless, so the result does not depend on the scale of the model. The length
/// over which the field evens out is about (stiffness * (k_max - k_min) / diagonal)^(-1/2): it
/// falls with curvature as the distance of lines does, so that lines may turn within as many cells
/// everywhere. The loss is that of Geman and McClure (at most 1), for what disagrees with its
/// surroundings altogether (noise, details smaller than those) to be given up instead of bending
/// the field half-way. A few linear solves with weights from the solution before. Beyond [MK04];
/// 4-symmetric after Palacios and Zhang 2007.
///
/// Guides hold like features on the faces that they pass. Within their reach their direction takes
/// the place of the principal one, with a hold that fades out towards its end.
/// \param graph   of the mesh
/// \param guides  empty for none
/// \return number of iterations of the linear solver, of all solves together
Index extend_cross_field(const TriMesh& mesh, const WedgeGraph& graph, double stiffness,
                         const GuidePull& guides, PrincipalField& field);

}  // namespace strake
