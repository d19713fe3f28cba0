#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/core/attributes.h"
#include "common/core/types.h"

namespace strake {

/// A polygon mesh as in a file: what readers return and what remeshing produces.
struct PolyMesh {
  std::vector<Vec3> positions;  ///< [V], model coordinates
  std::vector<Index> offsets = {
      0};                      ///< [F + 1] face f has the corners offsets[f] .. offsets[f + 1] - 1
  std::vector<Index> corners;  ///< vertex of each corner, counter-clockwise
  Attributes attributes = {};

  [[nodiscard]] Index vertex_count() const { return static_cast<Index>(positions.size()); }
  [[nodiscard]] Index face_count() const { return static_cast<Index>(offsets.size()) - 1; }
  [[nodiscard]] std::span<const Index> face(Index f) const {
    return {corners.data() + offsets[f], static_cast<std::size_t>(offsets[f + 1] - offsets[f])};
  }
  /// The corner after one of a face's corners, and the one before it.
  [[nodiscard]] Index next_corner(Index f, Index corner) const {
    return corner + 1 == offsets[f + 1] ? offsets[f] : corner + 1;
  }
  [[nodiscard]] Index previous_corner(Index f, Index corner) const {
    return (corner == offsets[f] ? offsets[f + 1] : corner) - 1;
  }
  void add_face(std::span<const Index> vertices) {
    corners.insert(corners.end(), vertices.begin(), vertices.end());
    offsets.push_back(static_cast<Index>(corners.size()));
  }
};

/// Where each vertex of a remeshed surface comes from.
struct VertexProvenance {
  std::vector<Index> face;                         ///< [V] face of the TriMesh
  std::vector<std::array<double, 3>> barycentric;  ///< [V] of the vertex's foot in that face
  std::vector<std::array<Index, 2>> lines;         ///< [V] the two lines that cross there, or kNone
};

/// A remeshed surface: an oriented 2-manifold of polygons with at most `max_sides` corners.
struct QuadMesh {
  std::string mesh_id;  ///< of the TriMesh it approximates
  PolyMesh mesh;
  VertexProvenance provenance;
};

}  // namespace strake
