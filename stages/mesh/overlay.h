#pragma once

#include <array>
#include <vector>

#include "common/core/line_set.h"
#include "common/core/observer.h"
#include "common/core/tri_mesh.h"
#include "stages/mesh/dart_graph.h"

namespace strake {

enum class EdgeKind : std::uint8_t {
  surface,   ///< piece of a triangle edge, of no meaning in itself
  line,      ///< piece of a traced line
  feature,   ///< piece of a feature edge
  boundary,  ///< piece of a boundary edge
};

/// A node of the overlay: where it lies on the triangle mesh.
struct SurfaceNode {
  Vec3 position;
  Index face = kNone;
  std::array<double, 3> barycentric{};
  Index vertex = kNone;  ///< the mesh vertex it is, or kNone
};

/// The common subdivision of a triangle mesh and the lines on it.
///
/// Nodes are the mesh vertices (first), then the points of lines on edges, then the crossings of
/// chords inside faces.
struct Overlay {
  DartGraph graph;
  std::vector<SurfaceNode> nodes;
  std::vector<EdgeKind> kind;  ///< [edges]
  std::vector<Index> line;     ///< [edges] line of the LineSet, kNone on surface edges
  std::vector<Index> chord;    ///< [edges] chord within its face while faces are cut; kNone else
};

/// Cuts the mesh along all lines.
///
/// Two chords of a face cross if and only if their ends interleave on the face's boundary, and then
/// once: decided by the order of points along edges alone. Positions are computed afterwards and
/// only choose between orders that are all consistent, so the result is an embedding whatever
/// rounding does.
/// \throw PreconditionError where a chord does not join two sides of its face
Overlay build_overlay(const TriMesh& mesh, const LineSet& lines, Observer& observer);

/// Reduces an overlay to the lines, features and boundaries, without dangling ends.
///
/// Surface edges are removed as long as that merges two different cells, so all cells stay disks;
/// what must stay to keep them so are cut lines. \return the number of cut edges left
Index reduce_to_lines(Overlay& overlay);

}  // namespace strake
