#pragma once

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake::import {

/// Gives a mesh the colours and labels of the polygons it was made from, by its sources. A vertex
/// that was inserted gets the mean colour of its neighbours, of those that have one.
///
/// Texture coordinates belong to corners and travel with the faces instead (`Soup::texture`).
void carry_attributes(const PolyMesh& input, TriMesh& mesh);

}  // namespace strake::import
