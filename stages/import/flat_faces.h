#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Removes triangles without area from a manifold where that leaves the surface as it is.
///
/// Edges shorter than 1e-10 of the diagonal are collapsed where the link condition holds; shorter
/// than 1e-6 where slivers were found that a union has left, as its seams are full of them.
/// Triangles lower than 1e-6 of their longest edge are removed by flipping that edge, where the two
/// new triangles are better shaped, look the same way as the neighbour, and the new edge is not
/// there yet. What can be removed in neither way stays.
/// \param twin  [3F] opposite half-edges, kNone on the boundary; not kept up to date
void remove_flat_faces(Soup& soup, std::vector<Index> twin, double diagonal, Repairs& repairs);

/// A surface with less area than this share of the square of its extent has none.
inline constexpr double kThinnest = 1e-9;

/// Removes connected pieces that have no area as a whole: points and lines, however many triangles;
/// and narrow ones (`is_narrow`) that were cut off others: slivers that a union has left.
/// \pre vertices that were copied for fans have the same source vertex
void drop_pieces_without_area(Soup& soup, double diagonal, Repairs& repairs);

}  // namespace strake::import
