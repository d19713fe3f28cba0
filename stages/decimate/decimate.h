#pragma once

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct DecimateOptions {
  std::int64_t vertices = 1000;  ///< of the result

  OptionList declare();
};

struct DecimateResult {
  QuadMesh quads;
  Report report;
};

/// Makes a mesh of few vertices by decimating the surface, and of its triangles quads in pairs.
///
/// Beyond [MK04], for counts too small for lines: these must run past each detail at about the
/// distance of its size, while here a vertex goes only where the surface misses it least (Garland &
/// Heckbert 1997). Vertices are some of the surface's. Those on feature and boundary lines go last
/// across them, and corners last of all.
/// \return the topology of the surface; a count that it does not allow is missed and warned of
/// \throw AlgorithmError where the result fails its own check
/// Cost O(V log V). Deterministic; one thread.
DecimateResult decimate_to_quads(const TriMesh& mesh, const DecimateOptions& options,
                                 Observer& observer);

}  // namespace strake
