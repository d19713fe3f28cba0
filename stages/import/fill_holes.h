#pragma once

#include <cstdint>

#include "stages/import/soup.h"

namespace strake::import {

/// What became of the holes of a surface.
struct FilledHoles {
  std::int64_t filled = 0;
  std::int64_t left = 0;  ///< no faces with an area fit into them
  double widest = 0;      ///< of those filled: the diagonal of its box, model units
};

/// Fills the holes of an oriented manifold that are at most `most_across` wide, the diagonal of the
/// box around their outlines. An outline of more than half the size of its component is not that of
/// a hole, but where the component ends.
///
/// After Liepa 2003, Filling Holes in Meshes: the patch that turns least is divided until its
/// triangles are as large as those around, and faired so that it goes on from the surface smoothly:
/// least is the sum of the squares of the umbrella vectors of its vertices and of its outline's.
/// New faces have the source face of the outline's edge that they are nearest to, and new vertices
/// texture coordinates between those of the outline.
/// \pre every edge has at most two faces, every vertex one fan
FilledHoles fill_holes(Soup& soup, double most_across);

/// How many it would fill, if all can be.
Index count_holes(const Soup& soup, double most_across);

}  // namespace strake::import
