#include "common/geometry/density.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/core/error.h"
#include "common/geometry/topology/vertex_ring.h"

namespace strake {
namespace {

/// Of a vertex that repairs inserted: the mean of those around it that were in the file; 1 where
/// there is none.
double mean_density_around(const TriMesh& mesh, const DensityField& density, Index vertex) {
  double sum = 0;
  int count = 0;
  for_each_neighbour(mesh, vertex, [&](Index v) {
    if (mesh.source_vertex[v] == kNone) return;
    sum += density.value[mesh.source_vertex[v]];
    ++count;
  });
  return count > 0 ? sum / count : 1;
}

double density_at(const TriMesh& mesh, const DensityField& density, Index vertex) {
  const Index source = mesh.source_vertex[vertex];
  return source == kNone ? mean_density_around(mesh, density, vertex) : density.value[source];
}

}  // namespace

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
  for (const Index v : mesh.wedge_vertex) values.push_back(density_at(mesh, density, v));
  return values;
}

}  // namespace strake
