#pragma once

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "stages/fit/vertex_places.h"

namespace strake::fitting {

/// Evens out the vertices inside flats, which cost nothing wherever they are: each goes to the
/// middle of its neighbours in the plane, again and again, and then to where its edges are straight
/// along the field, too.
///
/// Lines come into a flat as its outline sends them, crowded or far apart. A vertex counts as
/// inside where it is free and all corners of the faces around it lie in its tangent plane. No
/// corner gets narrower, or straighter, than half of what it is in a regular face, unless it was.
/// \param field  nullptr: no edge has a direction to keep to
/// \param off    distance from a plane up to which a vertex is in it, model units
/// \return number of vertices moved
/// Cost O(vertices inside flats * sweeps), at most 80 of these.
Index even_flats(const PolyMesh& mesh, const PrincipalField* field, double off,
                 VertexPlaces& places);

}  // namespace strake::fitting
