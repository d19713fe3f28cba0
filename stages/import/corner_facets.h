#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// The flats that are left of a corner where chamfers meet, each as the half-edges around it.
///
/// Their edges are bent less than creases (35 degrees where the chamfers of a block do, which are
/// bent by 45), and at each end of these at least two edges are bent like creases. On a round,
/// whose facets lie between two rims, some edges of a facet always are.
///
/// \param bend     [3F] radians
/// \param shallow  radians; the edges around are bent by more
/// \param angle    radians; creases are bent by more, and the edges around are not
/// Cost O(F), with little memory where no edges are like that.
std::vector<std::vector<Index>> find_corner_facets(const TriMesh& mesh,
                                                   const std::vector<float>& bend, double shallow,
                                                   double angle);

}  // namespace strake::import
