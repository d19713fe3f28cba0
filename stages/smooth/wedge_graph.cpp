#include "stages/smooth/wedge_graph.h"

namespace strake {
namespace {

/// Calls use(wedge, neighbour, half-edge) for all edges of the graph, those of a wedge always in
/// the same order.
template <class Use>
void for_edges(const TriMesh& mesh, const Use& use) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index i = mesh.wedge_of(h);
    const Index j = mesh.wedge_of(TriMesh::next(h));
    use(i, j, h);
    if (mesh.is_barrier(h)) use(j, i, h);  // the opposite half-edge belongs to other wedges
  }
}

}  // namespace

WedgeGraph wedge_graph(const TriMesh& mesh) {
  WedgeGraph graph;
  graph.offsets.assign(mesh.wedge_count() + 1, 0);
  for_edges(mesh, [&](Index i, Index, Index) { ++graph.offsets[i + 1]; });
  for (Index w = 0; w < mesh.wedge_count(); ++w) graph.offsets[w + 1] += graph.offsets[w];
  graph.neighbours.resize(graph.offsets.back());
  std::vector<Index> fill(graph.offsets.begin(), graph.offsets.end() - 1);
  for_edges(mesh, [&](Index i, Index j, Index) { graph.neighbours[fill[i]++] = j; });
  return graph;
}

std::vector<Index> graph_halfedges(const TriMesh& mesh, const WedgeGraph& graph) {
  std::vector<Index> halfedges(graph.neighbours.size());
  std::vector<Index> fill(graph.offsets.begin(), graph.offsets.end() - 1);
  for_edges(mesh, [&](Index i, Index, Index h) { halfedges[fill[i]++] = h; });
  return halfedges;
}

}  // namespace strake
