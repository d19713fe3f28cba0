#pragma once

#include <array>
#include <functional>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// What an edge costs between a corner of the outer and one of the inner path.
using BandCost = std::function<double(std::size_t outer, std::size_t inner)>;

/// Fills the band between two closed polygons, one inside the other, with triangles.
///
/// By dynamic programming (Fuchs, Kedem & Uselton 1977, Optimal Surface Reconstruction from Planar
/// Contours), from the edge between them that costs least: of all ways to go around both, the one
/// whose edges cost least together.
/// \param outer, inner  numbers of corners, at least 3 each; both go around in the same sense
/// \param cost          not negative
/// \param least         that an edge costs at least, if that is quicker to tell: the cost itself is
///                      only asked for where it may matter
/// \return outer + inner triangles in the sense of the polygons, of corners: the outer ones from 0
///         on, and the inner ones from `outer` on.
/// \throw PreconditionError for fewer corners
/// Cost and memory O(outer inner).
std::vector<std::array<Index, 3>> fill_band(std::size_t outer, std::size_t inner,
                                            const BandCost& cost, const BandCost& least = {});

/// The same between two paths, from the edge between their starts to the one between their ends.
/// \param outer, inner  numbers of corners, at least 1 each
/// \return outer + inner - 2 triangles.
/// \throw PreconditionError for no corners
std::vector<std::array<Index, 3>> fill_strip(std::size_t outer, std::size_t inner,
                                             const BandCost& cost, const BandCost& least = {});

}  // namespace strake
