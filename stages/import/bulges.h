#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// How far the curve that a border follows bulges over an edge of it, its chord.
struct Bulge {
  Vec3 way = Vec3::Zero();  ///< across the edge
  double height = 0;        ///< over its middle; 0 where the border has a corner at both ends
};

/// By the circle through the ends of each edge and the next vertex of the border, on the side where
/// it is bent more, up to 35 degrees.
/// \param border  half-edges of edges with one face
std::vector<Bulge> find_bulges(const Soup& soup, const std::vector<Index>& border);

}  // namespace strake::import
