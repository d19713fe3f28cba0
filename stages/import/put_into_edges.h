#pragma once

#include <vector>

#include "stages/import/border_contacts.h"
#include "stages/import/soup.h"

namespace strake::import {

/// Puts vertices into border edges and divides the faces of these, each piece where it was.
/// Texture coordinates are interpolated along the edges.
/// \param stops  of edges with one face, by half-edge, then along it; the vertices to put there
void put_into_edges(Soup& soup, const std::vector<Stop>& stops);

}  // namespace strake::import
