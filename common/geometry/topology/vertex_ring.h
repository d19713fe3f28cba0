#pragma once

#include "common/core/tri_mesh.h"

namespace strake {

/// Calls `visit` with every half-edge that leaves a vertex, counter-clockwise.
template <typename Visit>
void for_each_outgoing(const TriMesh& mesh, Index vertex, const Visit& visit) {
  const Index start = mesh.vertex_out[vertex];
  Index h = start;
  do {
    visit(h);
    h = mesh.rotate_ccw(h);
  } while (h != kNone && h != start);
}

/// Calls `visit` with every vertex that an edge joins to this one, once.
template <typename Visit>
void for_each_neighbour(const TriMesh& mesh, Index vertex, const Visit& visit) {
  for_each_outgoing(mesh, vertex, [&](Index h) {
    visit(mesh.to(h));
    if (mesh.is_boundary(TriMesh::prev(h))) visit(mesh.from(TriMesh::prev(h)));
  });
}

}  // namespace strake
