#include "stages/import/openings.h"

#include <fmt/format.h>

#include <algorithm>

#include "common/core/disjoint_sets.h"
#include "common/geometry/topology/topology.h"

namespace strake::import {

Openness openness(const Soup& soup) {
  Openness result;
  const EdgeGroups groups(soup);
  DisjointSets sets(soup.face_count());
  for (Index g = 0; g < groups.size(); ++g) {
    if (groups[g].size() == 1) ++result.boundary_edges;
    for (const Index h : groups[g].subspan(1)) sets.unite(groups[g][0] / 3, h / 3);
  }
  for (Index f = 0; f < soup.face_count(); ++f) result.components += sets.find(f) == f ? 1 : 0;
  return result;
}

Openness openness(const TriMesh& mesh) {
  return {static_cast<Index>(std::ranges::count(mesh.twin, kNone)), census(mesh).components};
}

std::string describe_openings(const Openness& before, const Openness& after) {
  std::string what;
  if (after.boundary_edges > before.boundary_edges) {
    what += fmt::format("opened the surface: it has {} boundary edges, and had {}",
                        after.boundary_edges, before.boundary_edges);
  }
  if (after.components > before.components) {
    what += fmt::format("{}: it has {} pieces, and had {}",
                        what.empty() ? "took the surface apart" : "; they took it apart",
                        after.components, before.components);
  }
  if (what.empty()) return what;
  return "repairs " + what +
         "; that is where more than two faces share an edge, faces are there twice, or the surface "
         "has one side only: where it should hold together there, unite its parts before (a "
         "boolean union), or remove what is there twice and what lies inside";
}

}  // namespace strake::import
