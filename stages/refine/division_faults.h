#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"

namespace strake {

/// Whether any vertex of a face is marked. \param flags  [V], or fewer: those beyond are not
bool has_any(std::span<const Index> face, const std::vector<std::uint8_t>& flags);

/// [V] 1: a vertex of a face that crosses another one, or of a concave one with a new vertex.
/// \param known  [vertices so far] 1: one of a face that crossed another one before; pairs of such
///               faces do not count, nor those without a new vertex
std::vector<std::uint8_t> vertices_of_faults(const PolyMesh& mesh,
                                             const std::vector<std::uint8_t>& known);

}  // namespace strake
