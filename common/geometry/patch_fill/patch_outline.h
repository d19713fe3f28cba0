#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// What is around some faces of a mesh, but for the mesh's boundary.
struct PatchOutline {
  struct Path {
    std::vector<Index> vertices;  ///< the faces are to their left
    bool is_closed = true;        ///< or it leads from the boundary to the boundary
  };

  std::vector<Path> paths;
  Index loops = 0;             ///< of all edges around the faces
  Index boundary_loops = 0;    ///< those of them that are loops of the boundary
  Index euler = 0;             ///< vertices - edges + faces
  std::vector<Index> pinched;  ///< where the outline touches itself; then all else is left out

  /// Whether the faces are a disk inside the mesh, with one path around them.
  [[nodiscard]] bool is_disk() const;
  /// Whether, if both are connected, one could be laid over the other.
  [[nodiscard]] bool is_like(const PatchOutline& other) const;
};

/// The outline of faces of one mesh.
/// \param faces        vertices of each, in one sense
/// \param is_wall      whether an edge is a part of the outline although there are faces on both
///                     sides; none where it is empty
/// \param is_boundary  whether an edge, in the sense of its face, is one of the mesh's boundary;
///                     none where it is empty
PatchOutline patch_outline(std::span<const std::vector<Index>> faces,
                           const std::function<bool(Index, Index)>& is_wall = {},
                           const std::function<bool(Index, Index)>& is_boundary = {});

}  // namespace strake
