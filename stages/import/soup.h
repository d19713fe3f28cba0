#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake::import {

using Triangle = std::array<Index, 3>;

/// An edge between vertices of the input that got others inside.
struct DividedEdge {
  Index from;
  Index to;
  std::vector<Index> inside;  ///< from `from` on; kNone of inserted vertices
};

/// A vertex of the input that another one took the place of.
struct JoinedVertex {
  Index gone;
  Index kept;
};

/// Triangles on the way from the file to a manifold; nothing is promised about how they meet.
struct Soup {
  std::vector<Vec3> positions;       ///< [V]
  std::vector<Index> source_vertex;  ///< [V] index in the input, kNone of inserted vertices
  std::vector<Triangle> faces;       ///< [F]
  std::vector<Index> source_face;    ///< [F] index in the input
  std::vector<std::array<TexturePoint, 3>> texture;  ///< [F] of corners; empty without
  std::vector<std::vector<DividedEdge>> divided;     ///< where borders were sewn, round by round
  std::vector<JoinedVertex> joined;                  ///< not where both are at the same place

  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] Index face_count() const { return static_cast<Index>(faces.size()); }
  [[nodiscard]] Index halfedge_count() const { return 3 * face_count(); }
  [[nodiscard]] Index from(Index h) const { return faces[h / 3][h % 3]; }
  [[nodiscard]] Index to(Index h) const { return faces[h / 3][(h % 3 + 1) % 3]; }
};

/// What was changed, in elements.
struct Repairs {
  std::int64_t unusable_faces = 0;      ///< non-finite, out of range, fewer than three corners
  std::int64_t triangulated_faces = 0;  ///< polygons cut into triangles; no defect
  std::int64_t welded_vertices = 0;     ///< where borders coincide
  std::int64_t sewn_vertices = 0;       ///< across gaps between borders
  std::int64_t sewn_into_edges = 0;     ///< put into edges of borders that are divided differently
  std::int64_t degenerate_faces = 0;    ///< a corner twice
  std::int64_t duplicate_faces = 0;
  double duplicate_area = 0;            ///< of all copies but one, model units squared
  std::int64_t inner_faces = 0;         ///< of walls between solids that touch
  std::int64_t folded_slivers = 0;      ///< of both copies that a union has left
  std::int64_t faces_without_area = 0;  ///< of pieces that have none at all
  std::int64_t non_manifold_edges = 0;
  std::int64_t inserted_vertices = 0;  ///< to tell apart edges with the same two end points
  std::int64_t flipped_faces = 0;
  std::int64_t non_orientable_cuts = 0;    ///< edges
  std::int64_t split_vertices = 0;         ///< copies made
  std::int64_t flipped_edges = 0;          ///< to remove triangles without area
  std::int64_t collapsed_edges = 0;        ///< of zero length
  std::int64_t unreferenced_vertices = 0;  ///< dropped; no defect
  double weld_tolerance = 0;               ///< model units
  double widest_gap = 0;                   ///< between vertices that were sewn, model units
  double widest_divided_gap = 0;           ///< between vertices and edges they were put into
  double farthest_moved = 0;               ///< most that merging moved a corner by, model units
};

/// Half-edges of a soup grouped by edge: those with the same two vertices, in order of index.
class EdgeGroups {
 public:
  explicit EdgeGroups(const Soup& soup);
  [[nodiscard]] Index size() const { return static_cast<Index>(offsets_.size()) - 1; }
  [[nodiscard]] std::span<const Index> operator[](Index group) const {
    return {halfedges_.data() + offsets_[group],
            static_cast<std::size_t>(offsets_[group + 1] - offsets_[group])};
  }

 private:
  std::vector<Index> offsets_;
  std::vector<Index> halfedges_;
};

/// Removes the faces that are marked. \param remove  [F]
void remove_faces(Soup& soup, const std::vector<std::uint8_t>& remove);

double face_area(const Soup& soup, Index face);
double total_area(const Soup& soup);

/// Whether a patch in this box is narrower, in the mean, than 1e-5 of the diagonal of the model.
bool is_narrow(double area, const Eigen::AlignedBox3d& box, double diagonal);

/// Removes faces with a repeated corner.
void drop_degenerate_faces(Soup& soup, Repairs& repairs);

/// Removes faces with the same three vertices as an earlier one, in whichever order.
///
/// Where solids touch in faces that they share, what is left of these faces would be a wall inside:
/// patches of doubled faces all of whose border edges have two further faces are removed for good,
/// as are single faces folded onto each other where just such edges hold them. So are patches with
/// a free rim that are narrower than 1e-5 of the diagonal: one copy of them would open the solid
/// that they hang on.
void drop_duplicate_faces(Soup& soup, double diagonal, Repairs& repairs);

}  // namespace strake::import
