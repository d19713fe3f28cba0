#pragma once

#include "common/core/poly_mesh.h"

namespace strake::support {

/// A closed cone of radius 1 on z = 0, with its tip, vertex 0, at this height: `rings` bands of
/// triangles between `sides` rulings, and a fan as its base.
PolyMesh cone(int sides, int rings, double height);

}  // namespace strake::support
