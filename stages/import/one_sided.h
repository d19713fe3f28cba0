#pragma once

#include <span>
#include <vector>

#include "stages/import/soup.h"

namespace strake::import {

/// Finds where to cut a piece that has only one side so that it has two: along few and short edges,
/// which are the same for any order of faces.
///
/// Faces are joined to patches, and patches to larger ones, in rounds, each with the one that it
/// shares most of its outline with: less that along which they are turned against each other if
/// they look alike, or the other way round. What is left against that is cut, once no single face
/// makes it shorter by being turned. Where that is not shorter by a tenth, the edges along which
/// faces run the same way in the input are cut, and none is to be turned.
/// \param twin   [3F] the opposite half-edge of each, kNone on the boundary
/// \param faces  of the piece: all that the twins join
/// \return half-edges, one an edge
/// Cost O(F log^2 F).
std::vector<Index> cuts_of_one_sided(const Soup& soup, std::span<const Index> twin,
                                     std::span<const Index> faces);

}  // namespace strake::import
