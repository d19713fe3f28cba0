#include "stages/import/carry.h"

#include <algorithm>

#include "common/geometry/topology/vertex_ring.h"

namespace strake::import {
namespace {

Colour mean_colour_around(const TriMesh& mesh, Index vertex) {
  Colour sum{};
  int count = 0;
  for_each_neighbour(mesh, vertex, [&](Index v) {
    if (mesh.source_vertex[v] == kNone) return;
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += mesh.attributes.colour[v][i];
    ++count;
  });
  for (double& value : sum) value /= std::max(count, 1);
  return sum;
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
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.source_vertex[v] == kNone) to.colour[v] = mean_colour_around(mesh, v);
    }
  }
  to.material_files = from.material_files;
  for (const FaceLabels& labels : from.labels) {
    FaceLabels& carried = to.labels.emplace_back(FaceLabels{labels.name, {}, labels.names});
    carried.of_face.reserve(mesh.faces.size());
    for (const Index f : mesh.source_face) carried.of_face.push_back(labels.of_face[f]);
  }
}

}  // namespace strake::import
