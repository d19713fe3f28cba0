#pragma once

#include <functional>
#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// The outline of a hole, in the sense of the faces that fill it.
struct HoleOutline {
  std::vector<Vec3> places;  ///< [n]
  std::vector<Vec3> beyond;  ///< [n] unit normal of the face beyond the side that corner i begins
  /// [n] places that corner i is joined to around the hole, beside the two next to it.
  std::vector<std::vector<Vec3>> around;
};

/// What fills a hole.
struct HolePatch {
  std::vector<Triangle> faces;  ///< of corners of the outline, and from n on of `inside`
  std::vector<Vec3> inside;     ///< further vertices
};

/// \param may_join  whether there may be an edge between two corners of the outline
/// \return no faces where there is no such patch of faces with area
HolePatch patch_of(const HoleOutline& outline,
                   const std::function<bool(std::size_t, std::size_t)>& may_join);

}  // namespace strake::import
