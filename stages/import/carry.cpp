#include "stages/import/carry.h"

#include <cstdint>
#include <vector>

#include "common/geometry/topology/vertex_ring.h"

namespace strake::import {
namespace {

/// Colours the vertices that were inserted, from those around inwards.
void spread_colours(const TriMesh& mesh, std::vector<Colour>& colours) {
  std::vector<std::uint8_t> is_known(colours.size(), 0);
  std::vector<Index> unknown;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    is_known[v] = mesh.source_vertex[v] != kNone ? 1 : 0;
    if (is_known[v] == 0) unknown.push_back(v);
  }
  while (true) {
    std::vector<Index> reached;
    for (const Index v : unknown) {
      Colour sum{};
      int count = 0;
      for_each_neighbour(mesh, v, [&](Index u) {
        if (is_known[u] == 0) return;
        for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += colours[u][i];
        ++count;
      });
      if (count == 0) continue;
      for (std::size_t i = 0; i < sum.size(); ++i) colours[v][i] = sum[i] / count;
      reached.push_back(v);
    }
    if (reached.empty()) return;
    for (const Index v : reached) is_known[v] = 1;
    std::erase_if(unknown, [&](Index v) { return is_known[v] != 0; });
  }
}

}  // namespace

void carry_attributes(const PolyMesh& input, TriMesh& mesh) {
  const Attributes& from = input.attributes;
  Attributes& to = mesh.attributes;
  if (!from.colour.empty()) {
    to.colour.reserve(mesh.positions.size());
    for (const Index v : mesh.source_vertex) {
      to.colour.push_back(v == kNone ? Colour{} : from.colour[v]);
    }
    spread_colours(mesh, to.colour);
  }
  to.material_files = from.material_files;
  for (const FaceLabels& labels : from.labels) {
    FaceLabels& carried = to.labels.emplace_back(FaceLabels{labels.name, {}, labels.names});
    carried.of_face.reserve(mesh.faces.size());
    for (const Index f : mesh.source_face) carried.of_face.push_back(labels.of_face[f]);
  }
}

}  // namespace strake::import
