#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Joins pieces along borders that are divided differently, as exporters do that tessellate every
/// face of a solid by itself: vertices of one side are put into edges of the other.
///
/// Parts of border edges between such vertices are joined where two have their ends in the same
/// places, with a gap of at most a third of their length, and as `sew_gaps` joins edges otherwise.
/// Of three or more in the same places two are joined that are nearer to each other by far, or all
/// where they coincide. Nothing is joined that would leave the surface one side only. Nothing is
/// put into an edge that does not join it to something.
/// Cost that of `find_border_contacts`.
/// \param border  half-edges of edges with one face, ascending
/// \return those that are left, ascending
std::vector<Index> sew_divided_borders(Soup& soup, std::vector<Index> border, double diagonal,
                                       Repairs& repairs);

}  // namespace strake::import
