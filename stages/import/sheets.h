#pragma once

#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Makes a soup an oriented 2-manifold by cutting, never by gluing apart from edges that already
/// share their vertices.
///
/// In this order: sheets joined by edges of two faces are oriented consistently (the minority of
/// the faces is turned over; a closed or hollow sheet that is nearly evenly divided is turned
/// outwards) and cut open where they are not orientable; faces at an edge of three or more are
/// paired so that solids stay closed and sheets run on as flat as they can, the rest is cut apart
/// there; vertices with several fans get a copy for each; of several edges with the same two end
/// points all but one get a vertex in their middle.
/// \return twin [3F] the opposite half-edge of each, kNone on the boundary
/// \pre no face repeats a corner or the corners of another
std::vector<Index> make_manifold(Soup& soup, Repairs& repairs);

}  // namespace strake::import
