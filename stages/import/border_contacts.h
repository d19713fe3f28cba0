#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// A place inside a border edge beside which a vertex of a border lies.
struct Stop {
  Index halfedge;
  double share;  ///< of the way along it
  Index vertex;
  bool is_curved;  ///< it lies where the curve bulges that the border follows
};

/// Where borders meet.
struct BorderContacts {
  std::vector<Stop> stops;   ///< by half-edge, then along it
  std::vector<Index> place;  ///< [V] the lowest vertex of those of the border in the same place
};

/// Finds which vertices of borders are in the same place, and which lie inside edges of borders.
///
/// Both within 0.02 % of the diagonal, a fifth of the shortest edge at a vertex, of the way from a
/// stop to the ends of its edge, and of the height of the face there; and of what a vertex is near
/// to only the nearest, with what is at most 30 times as far away or within 1e-6 of the diagonal.
/// Inside an edge it may be farther away, up to 1 % of the diagonal, where the curve bulges that
/// the border follows: by a quarter more at most, and in that direction.
/// \param border  half-edges of edges with one face, ascending
/// Cost O(F + B log B).
BorderContacts find_border_contacts(const Soup& soup, const std::vector<Index>& border,
                                    double diagonal);

}  // namespace strake::import
