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

/// The first of these half-edges that is wanted; kNone where none is.
template <typename IsWanted>
Index find_outgoing(const TriMesh& mesh, Index vertex, const IsWanted& is_wanted) {
  const Index start = mesh.vertex_out[vertex];
  Index h = start;
  do {
    if (is_wanted(h)) return h;
    h = mesh.rotate_ccw(h);
  } while (h != kNone && h != start);
  return kNone;
}

/// Whether any of these half-edges is wanted.
template <typename IsWanted>
bool any_outgoing(const TriMesh& mesh, Index vertex, const IsWanted& is_wanted) {
  return find_outgoing(mesh, vertex, is_wanted) != kNone;
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
