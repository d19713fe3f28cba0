#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// The distances that lines were traced at.
SizeField used_distances(const LineSet& lines);

/// Distances in the ratios of `size`, and in the mean like others. \pre both of one mesh, positive
SizeField scaled_like(SizeField size, const SizeField& others);

/// Wanted distances, but closer than lines were around some places of the surface.
///
/// Beyond [MK04], for where lines at the distances that curvature asks for miss a tip, a pit or a
/// fold. The change is sudden; the tracing stage evens distances out.
/// \param wanted  [W] of `mesh`: before they were evened out, as those that were would shrink
///                everywhere when they are again
/// \param used    [W] that lines were traced at
/// \param places  model units, relative to the mesh's origin, on the surface or near it
/// \param factor  on both used distances there, from 0 to 1
/// Cost: the faces within two line distances of each place.
SizeField closer_near(const TriMesh& mesh, const SizeField& wanted, const SizeField& used,
                      const std::vector<Vec3>& places, double factor);

}  // namespace strake
