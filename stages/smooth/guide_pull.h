#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "stages/smooth/wedge_graph.h"

namespace strake {

/// How guide lines turn the cross field; empty without any.
struct GuidePull {
  std::vector<Vec3> direction;  ///< [W] unit, tangent; zero beyond the reach of all guides
  /// [W] from the nearest guide, as a share of the reach, along edges: 0 at the faces it passes, 1
  /// beyond its reach
  std::vector<double> distance;
};

/// Spreads the directions of `field.guides` over the surface around them, each wedge taking that of
/// the nearest guide. Not across features.
/// \param graph  of the mesh
/// \param reach  model units, not negative
GuidePull guide_pull(const TriMesh& mesh, const WedgeGraph& graph, const PrincipalField& field,
                     double reach);

}  // namespace strake
