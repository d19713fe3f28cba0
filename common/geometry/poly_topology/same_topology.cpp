#include "common/geometry/poly_topology/same_topology.h"

#include "common/core/error.h"
#include "common/geometry/topology/topology.h"

namespace strake {
namespace {

/// "components 2 instead of 1"; "" where they are as many.
std::string difference(const std::string& of, std::int64_t is, std::int64_t should) {
  if (is == should) return "";
  return of + " " + std::to_string(is) + " instead of " + std::to_string(should);
}

}  // namespace

void require_same_topology(const TriMesh& surface, const PolyTopology& result,
                           const std::string& what) {
  if (!result.is_oriented_manifold()) {
    throw AlgorithmError(what + " is no oriented manifold: " + result.defects() +
                         "; please report this model");
  }
  const Census wanted = census(surface);
  for (const std::string& found :
       {difference("components", result.components, wanted.components),
        difference("boundary loops", result.boundary_loops, wanted.boundary_loops),
        difference("Euler characteristic", result.euler, wanted.euler_characteristic)}) {
    if (found.empty()) continue;
    throw AlgorithmError(what + " has another topology than the surface: " + found +
                         "; please report this model");
  }
}

}  // namespace strake
