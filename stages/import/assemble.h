#pragma once

#include "common/core/tri_mesh.h"
#include "stages/import/soup.h"

namespace strake::import {

/// Turns a manifold soup into a mesh: faces breadth-first from the first one of each component,
/// vertices in order of first use, so that neighbours lie near each other in memory. The order does
/// not depend on coordinates. Vertices that no face uses are left out.
/// \return positions, faces, texture coordinates, sources and topology; no features, wedges,
/// origin, diagonal or id
TriMesh assemble(const Soup& soup);

}  // namespace strake::import
