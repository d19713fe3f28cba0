#pragma once

#include <vector>

#include "common/core/line_set.h"
#include "common/core/observer.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/surface_point.h"
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
  Vec3 offset = Vec3::Zero();  ///< of the position from the surface: on ragged boundaries
  SurfacePoint at;
  Index vertex = kNone;  ///< the mesh vertex it is, or kNone
};

/// The nodes of an overlay: the mesh vertices, then the points of lines on edges, then the
/// crossings of chords inside faces. Those of the first two kinds, nearly all, are made when asked
/// for.
class OverlayNodes {
 public:
  explicit OverlayNodes(const TriMesh& mesh) : mesh_(&mesh) {}

  [[nodiscard]] Index size() const {
    return first_crossing() + static_cast<Index>(crossings_.size());
  }
  [[nodiscard]] SurfaceNode operator[](Index n) const;
  /// \pre no crossing was added yet, and the point lies inside an edge \return the node
  Index add_edge_point(const LinePoint& point);
  /// \return the node
  Index add_crossing(Index face, const Vec3& barycentric);

 private:
  [[nodiscard]] Index first_crossing() const {
    return mesh_->vertex_count() + static_cast<Index>(edge_points_.size());
  }

  const TriMesh* mesh_;  ///< not owned
  std::vector<LinePoint> edge_points_;
  std::vector<SurfaceNode> crossings_;
};

/// The common subdivision of a triangle mesh and the lines on it.
struct Overlay {
  explicit Overlay(const TriMesh& mesh) : nodes(mesh) {}

  DartGraph graph;
  OverlayNodes nodes;
  std::vector<EdgeKind> kind;  ///< [edges]
  std::vector<Index> line;     ///< [edges] line of the LineSet, kNone on surface edges
};

/// Cuts the mesh along all lines.
///
/// Two chords of a face cross if and only if their ends interleave on the face's boundary, and then
/// once: decided by the order of points along edges alone. Positions are computed afterwards and
/// only choose between orders that are all consistent, so the result is an embedding whatever
/// rounding does.
/// \throw PreconditionError where a chord does not join two sides of its face
Overlay build_overlay(const TriMesh& mesh, const LineSet& lines, Observer& observer);

/// Reduces an overlay to the lines, features and boundaries, without dangling ends but those of
/// features.
///
/// Surface edges are removed as long as that merges two different cells, so all cells stay disks;
/// what must stay to keep them so are cut lines.
/// \return the number of cut edges left
Index reduce_to_lines(Overlay& overlay);

}  // namespace strake
