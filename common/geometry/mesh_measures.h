#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

/// Whether a face has an area to speak of, and so a normal that is not taken from its neighbours.
bool has_own_normal(const TriMesh& mesh, Index face);

/// [F] unit normals. A face without area takes the normal of its neighbours across its longest
/// edges, so that slivers neither bend the surface nor turn over.
std::vector<Vec3> face_normals(const TriMesh& mesh);

/// [W] unit normals, angle-weighted over the faces of each wedge.
std::vector<Vec3> wedge_normals(const TriMesh& mesh, const std::vector<Vec3>& face_normals);

/// [W] a third of the area of each wedge's faces.
std::vector<double> wedge_areas(const TriMesh& mesh);

/// Angle at corner h of its face, radians in [0, pi].
double corner_angle(const TriMesh& mesh, Index h);

}  // namespace strake
