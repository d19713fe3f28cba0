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

void require(std::int64_t components, std::int64_t boundary_loops, std::int64_t euler,
             const PolyTopology& result, const std::string& what) {
  if (!result.is_oriented_manifold()) {
    throw AlgorithmError(what + " is no oriented manifold: " + result.defects() +
                         "; please report this model");
  }
  for (const std::string& found :
       {difference("components", result.components, components),
        difference("boundary loops", result.boundary_loops, boundary_loops),
        difference("Euler characteristic", result.euler, euler)}) {
    if (found.empty()) continue;
    throw AlgorithmError(what + " has another topology than the surface: " + found +
                         "; please report this model");
  }
}

}  // namespace

void require_same_topology(const TriMesh& surface, const PolyTopology& result,
                           const std::string& what) {
  const Census wanted = census(surface);
  require(wanted.components, wanted.boundary_loops, wanted.euler_characteristic, result, what);
}

void require_same_topology(const PolyMesh& before, const PolyTopology& result,
                           const std::string& what) {
  const PolyTopology wanted = analyse(before);
  require(wanted.components, wanted.boundary_loops, wanted.euler, result, what);
}

}  // namespace strake
