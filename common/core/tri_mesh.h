#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/attributes.h"
#include "common/core/types.h"

namespace strake {

/// An oriented 2-manifold triangle mesh with boundary and a feature graph.
///
/// Half-edge h = 3 f + i runs from corner i of face f to corner (i + 1) % 3, and names that corner
/// too. A *wedge* (Hoppe 1998) is a run of corners around a vertex between two feature or boundary
/// edges: fields live on wedges, so nothing is averaged across a crease. Without features there is
/// one wedge per vertex.
///
/// Invariants (established by `build_topology`, checked by `validate`): every edge has one or two
/// faces, oppositely oriented; every vertex is used and has one fan of faces; no face repeats a
/// corner; feature flags are equal on both half-edges of an edge.
struct TriMesh {
  std::vector<Vec3> positions;              ///< [V], model units, relative to `origin`
  std::vector<std::array<Index, 3>> faces;  ///< [F], counter-clockwise seen from outside

  std::vector<Index> twin;  ///< [3F] opposite half-edge, kNone on the boundary
  std::vector<Index>
      vertex_out;  ///< [V] an outgoing half-edge; the clockwise-most one on a boundary
  std::vector<std::uint8_t> is_feature;  ///< [3F] 1 on feature half-edges, boundary excluded
  std::vector<std::uint8_t> is_corner;  ///< [V] 1 where feature or boundary lines end, meet or turn
                                        ///< sharply; tips of cones

  std::vector<std::array<Index, 3>> face_wedges;  ///< [F] wedge of each corner
  std::vector<Index> wedge_vertex;                ///< [W] vertex of each wedge

  std::vector<Index>
      source_vertex;  ///< [V] index in the file read; kNone of vertices that repairs inserted
  std::vector<Index> source_face;  ///< [F] index in the file read (before triangulation)

  /// [W] of a coarser mesh of another one: the wedge of that, at the same place; else empty.
  std::vector<Index> parent_wedge;
  std::string parent_id;  ///< of that mesh

  Attributes attributes;  ///< corner i of face f is half-edge 3 f + i

  Vec3 origin = Vec3::Zero();  ///< to be added to `positions` for model coordinates
  double diagonal = 0;         ///< of the bounding box, model units
  std::string id;              ///< content hash; equal meshes have equal ids

  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] Index face_count() const { return static_cast<Index>(faces.size()); }
  [[nodiscard]] Index halfedge_count() const { return 3 * face_count(); }
  [[nodiscard]] Index wedge_count() const { return static_cast<Index>(wedge_vertex.size()); }

  static Index face_of(Index h) { return h / 3; }
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] Index from(Index h) const { return faces[h / 3][h % 3]; }
  [[nodiscard]] Index to(Index h) const { return from(next(h)); }
  [[nodiscard]] bool is_boundary(Index h) const { return twin[h] == kNone; }
  /// Whether fields end at this edge: a feature or boundary edge.
  [[nodiscard]] bool is_barrier(Index h) const { return twin[h] == kNone || is_feature[h] != 0; }
  [[nodiscard]] Index edge_of(Index h) const {
    return twin[h] == kNone || h < twin[h] ? h : twin[h];
  }
  /// The next outgoing half-edge counter-clockwise around from(h); kNone past a boundary.
  [[nodiscard]] Index rotate_ccw(Index h) const { return twin[prev(h)]; }
  /// The next outgoing half-edge clockwise around from(h); kNone past a boundary.
  [[nodiscard]] Index rotate_cw(Index h) const { return twin[h] == kNone ? kNone : next(twin[h]); }
  [[nodiscard]] Index wedge_of(Index h) const { return face_wedges[h / 3][h % 3]; }
};

}  // namespace strake
