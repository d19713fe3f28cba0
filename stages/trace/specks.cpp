#include "stages/trace/specks.h"

#include <algorithm>
#include <limits>

#include "common/geometry/topology/topology.h"

namespace strake {

std::vector<std::uint8_t> faces_of_specks(const TriMesh& mesh, const Spacing& spacing) {
  const std::vector<Index> component = face_components(mesh);
  const std::vector<double> extents = component_extents(mesh, component);
  std::vector<double> least(extents.size(), std::numeric_limits<double>::infinity());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    double& distance = least[component[f]];
    for (const Index w : mesh.face_wedges[f]) {
      distance = std::min({distance, spacing.along[w], spacing.across[w]});
    }
  }
  std::vector<std::uint8_t> is_of_speck(component.size());
  std::transform(component.begin(), component.end(), is_of_speck.begin(),
                 [&](Index c) { return extents[c] <= least[c] ? 1 : 0; });
  return is_of_speck;
}

}  // namespace strake
