#pragma once

#include <string>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/poly_topology.h"

namespace strake {

/// Holds a result to the topology of the surface it was made from, or of the faces it had before:
/// what every stage that makes faces promises.
///
/// \param what  the result, in messages: "the decimated mesh"
/// \throw AlgorithmError where it is no oriented manifold, or has another number of components or
///        boundary loops, or another Euler characteristic; with both numbers
void require_same_topology(const TriMesh& surface, const PolyTopology& result,
                           const std::string& what);
void require_same_topology(const PolyMesh& before, const PolyTopology& result,
                           const std::string& what);

}  // namespace strake
