#include "common/geometry/density.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/core/error.h"

namespace strake {

std::vector<double> density_at_wedges(const TriMesh& mesh, const DensityField& density) {
  const Index last = *std::max_element(mesh.source_vertex.begin(), mesh.source_vertex.end());
  if (last >= static_cast<Index>(density.value.size())) {
    throw PreconditionError("the density has " + std::to_string(density.value.size()) +
                            " vertices, but the mesh was made from a file with " +
                            std::to_string(last + 1) +
                            " or more; give a density of that file's vertices");
  }
  for (std::size_t i = 0; i < density.value.size(); ++i) {
    if (density.value[i] > 0 && std::isfinite(density.value[i])) continue;
    throw InputError("the density of vertex " + std::to_string(i) + " is no positive number");
  }
  std::vector<double> values;
  values.reserve(mesh.wedge_vertex.size());
  for (const Index v : mesh.wedge_vertex) values.push_back(density.value[mesh.source_vertex[v]]);
  return values;
}

}  // namespace strake
