#pragma once

#include <array>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"
#include "stages/fit/block_system.h"
#include "stages/fit/vertex_places.h"

namespace strake::fitting {

/// How far boundary edges of a result are from the boundary of the surface.
///
/// Distances of faces hardly tell: what an edge cuts off a bent boundary, or adds to it, is narrow,
/// and far off in its middle only. But an outline is what one sees first, and of a flat all there
/// is. So an edge counts as if its cell were as far off, some times over, as the edge is from the
/// vertices of the boundary between its ends.
class Outline {
 public:
  /// \param places  where the vertices of `mesh` are; kept by reference, as `mesh` is
  Outline(const PolyMesh& mesh, const VertexPlaces& places);

  /// Sum of weight times area times squared distance.
  [[nodiscard]] double cost() const;
  /// Adds the least-squares problem of closing these gaps by moves of the vertices.
  void add_to(BlockSystem& system) const;

 private:
  struct Edge {
    std::array<Index, 2> ends;  ///< in the order of the face
    Index face;
  };
  struct Gap {
    std::array<Index, 2> ends;
    std::array<double, 2> shares;  ///< of the ends in the place on the edge
    Vec3 way;                      ///< from there to the vertex of the boundary
    double weight;                 ///< area
  };
  template <class Use>
  void for_gaps(const Use& use) const;

  const PolyMesh& mesh_;
  const VertexPlaces& places_;
  std::vector<Edge> edges_;
};

}  // namespace strake::fitting
