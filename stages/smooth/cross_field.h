#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "stages/smooth/wedge_graph.h"

namespace strake {

/// Fills `field.cross` with the smoothest 4-symmetric direction field that holds to the principal
/// directions where they are reliable and to feature and boundary lines.
///
/// Minimises the Dirichlet energy of cross_power(cross) plus, at every wedge, `stiffness` *
/// confidence^2 * (k_max - k_min)^2 * area times the squared deviation from the principal
/// direction: dimensionless, so the result does not depend on the scale of the model. One linear
/// solve. Beyond [MK04]; 4-symmetric after Palacios and Zhang 2007.
/// \param graph of the mesh \param areas [W] \return number of iterations of the linear solver
Index extend_cross_field(const TriMesh& mesh, const WedgeGraph& graph,
                         const std::vector<double>& areas, double stiffness, PrincipalField& field);

}  // namespace strake
