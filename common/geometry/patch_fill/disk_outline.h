#pragma once

#include <functional>
#include <span>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// What is around some faces.
struct DiskOutline {
  std::vector<Index> ring;     ///< counter-clockwise; empty where the faces are no disk
  std::vector<Index> pinched;  ///< where the outline touches itself; then there is no disk either
};

/// The outline of faces of one mesh, if they are a disk.
/// \param faces    vertices of each, in one sense; at least one face
/// \param is_wall  whether the edge between two vertices is a part of the outline although there
///                 are faces on both sides; none where it is empty
DiskOutline disk_outline(std::span<const std::vector<Index>> faces,
                         const std::function<bool(Index, Index)>& is_wall = {});

}  // namespace strake
