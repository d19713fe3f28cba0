#include "stages/import/turn_outwards.h"

#include <numeric>
#include <utility>
#include <vector>

#include "common/geometry/topology/closed_components.h"
#include "common/geometry/topology/topology.h"

namespace strake::import {

Index turn_outwards(TriMesh& mesh) {
  const std::vector<std::uint8_t> is_to_turn = judge_closed_components(mesh).is_to_turn;
  const std::vector<Index> component = face_components(mesh);
  for (Index f = 0; f < mesh.face_count(); ++f) {
    if (is_to_turn[component[f]] == 0) continue;
    std::swap(mesh.faces[f][1], mesh.faces[f][2]);
    if (mesh.attributes.texture.empty()) continue;
    std::swap(mesh.attributes.texture[3 * f + 1], mesh.attributes.texture[3 * f + 2]);
  }
  build_topology(mesh);
  return std::accumulate(is_to_turn.begin(), is_to_turn.end(), Index{0});
}

}  // namespace strake::import
