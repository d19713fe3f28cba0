#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/observer.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A triangle mesh between some of the vertices of a surface.
struct CoarseSurface {
  std::vector<Vec3> positions;  ///< [V] relative to the surface's origin
  std::vector<Index> vertex;    ///< [V] of the surface
  std::vector<std::array<Index, 3>> faces;
  /// [3F] whether half-edge 3 f + i, from corner i of face f to the next, is part of a feature or
  /// boundary line.
  std::vector<std::uint8_t> is_barrier;
};

/// Takes vertices out of a surface, one by one, each the one that is missed least.
///
/// A vertex is merged into a neighbour. Least is the sum of squared distances of the neighbour from
/// the planes of all faces that were around either, weighted by area, and from planes upright on
/// feature and boundary edges (Garland & Heckbert 1997). Corners stay and other vertices of such
/// lines only move along them, until nothing else is left. In parts of the result that are flat
/// diagonals are turned where that makes the smallest angle larger.
/// \return the surface's topology, with `count` vertices, or as few as that allows
/// \throw AlgorithmError where OpenMesh does not take the surface
CoarseSurface collapse_to(const TriMesh& mesh, Index count, Observer& observer);

}  // namespace strake
