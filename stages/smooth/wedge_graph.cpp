#include "stages/smooth/wedge_graph.h"

namespace strake {

WedgeGraph wedge_graph(const TriMesh& mesh) {
  WedgeGraph graph;
  graph.offsets.assign(mesh.wedge_count() + 1, 0);
  const auto each = [&](auto&& use) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      const Index i = mesh.wedge_of(h);
      const Index j = mesh.wedge_of(TriMesh::next(h));
      use(i, j, h);
      if (mesh.is_barrier(h)) use(j, i, h);  // the opposite half-edge belongs to other wedges
    }
  };
  each([&](Index i, Index, Index) { ++graph.offsets[i + 1]; });
  for (Index w = 0; w < mesh.wedge_count(); ++w) graph.offsets[w + 1] += graph.offsets[w];
  graph.neighbours.resize(graph.offsets.back());
  graph.halfedges.resize(graph.offsets.back());
  std::vector<Index> fill(graph.offsets.begin(), graph.offsets.end() - 1);
  each([&](Index i, Index j, Index h) {
    graph.halfedges[fill[i]] = h;
    graph.neighbours[fill[i]++] = j;
  });
  return graph;
}

}  // namespace strake
