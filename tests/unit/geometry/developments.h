#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// A triangle mesh in space that unfolds into the plane without stretching, and how it does.
struct Development {
  TriMesh mesh;
  std::vector<Vec2> flat;                 ///< [V] the vertices unfolded
  std::function<Vec3(const Vec2&)> fold;  ///< plane to space, for any point of the surface
};

/// A prism of 24 flat facets, cut open, with irregular triangles.
Development cylinder_development(std::uint64_t seed);

/// A pyramid of 18 flat facets without its tip, cut open.
Development cone_development(std::uint64_t seed);

/// The three squares around a corner of a cube, cut open along an edge: three quarters of a plane.
Development cube_corner_development(std::uint64_t seed);

}  // namespace strake
