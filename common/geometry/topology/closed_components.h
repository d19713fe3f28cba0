#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Components without a boundary, and which way their faces look.
struct ClosedComponents {
  Index count = 0;
  /// Of negative volume, where nothing around makes them cavities.
  Index inside_out = 0;
  /// Of negative volume, inside others that enclose more often outwards than inwards.
  Index cavities = 0;
  /// [components] What turned over makes all look outwards: what is inside out, and what lies
  /// inside of that, so that its cavities stay such.
  std::vector<std::uint8_t> is_to_turn;
};

/// Judges each closed component by its signed volume; one without volume to speak of is not
/// judged. One that lies inside another only in part is no cavity.
/// \param component  [F] of each face
/// \param is_closed  [components] whether all edges have two faces, oppositely oriented
/// Cost O(F log C) for C components, and a step for each point (9 of a component) that lies below a
/// face within the height of the face's component.
ClosedComponents judge_closed_components(std::span<const Vec3> positions,
                                         std::span<const std::array<Index, 3>> faces,
                                         std::span<const Index> component,
                                         std::span<const std::uint8_t> is_closed);

/// \pre build_topology has run
ClosedComponents judge_closed_components(const TriMesh& mesh);

}  // namespace strake
