#pragma once

#include <functional>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/samples/samples.h"

namespace strake {

/// A sample without feature edges, vertices in its own order.
TriMesh sample_mesh(SampleKind kind, std::int64_t faces, double jitter = 0.25);

/// A field with the mesh's own normals, the given direction projected into the tangent plane as
/// t_min and cross, and no curvature.
PrincipalField field_along(const TriMesh& mesh, const std::function<Vec3(const Vec3&)>& direction);

/// Turns the cross of every wedge by a random multiple of a right angle.
void turn_crosses(PrincipalField& field, std::uint64_t seed);

}  // namespace strake
