#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Joins pieces along borders that run side by side with a gap far smaller than their edges, as
/// patches of a CAD model do that were divided alike and written with few digits.
///
/// Two border edges are joined by their ends where each is the other's nearest, by far, the gap is
/// at most 0.02 % of the diagonal and a fifth of any edge at these ends, and the surface goes on
/// from face to face. What stays: sheets that lie on top of each other (a thin open shell), and
/// slits, borders apart by more than 0.002 % of the diagonal that leave room all along, while those
/// of patches overlap in one place and gape in another. Up to 1e-6 of the diagonal, what single
/// precision leaves, neither is looked at.
/// \param border  half-edges of edges with one face
/// \return those that are left, ascending
/// Cost O(F + B log B) for B border edges.
std::vector<Index> sew_gaps(Soup& soup, const std::vector<Index>& border, double diagonal,
                            Repairs& repairs);

/// Border edges beside another one.
struct NearBorders {
  Index edges = 0;
  double widest = 0;  ///< the largest of their distances, model units
};

/// Finds border edges whose middle is within 0.05 % of the diagonal and a quarter of their length
/// of another border edge along them, where the surface would go on and no strip lies between;
/// notches of an outline, one edge deep, are none.
/// \param border  half-edges of edges with one face
NearBorders find_near_borders(const Soup& soup, const std::vector<Index>& border, double diagonal);

}  // namespace strake::import
