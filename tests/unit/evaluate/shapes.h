#pragma once

#include <functional>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

/// Polygon meshes of known shape and connectivity for the tests of this folder.
namespace strake::shapes {

/// An n x m grid of quads over the unit square of parameters, each vertex placed by `place(s, t)`.
/// Closing a direction joins its last row to its first, so that s = 1 (t = 1) is never asked for.
PolyMesh grid(Index n, Index m, bool close_s, bool close_t,
              const std::function<Vec3(double, double)>& place);

/// [0, 1] x [0, 1] in the plane z = `height`, normal +z.
PolyMesh square(Index n, double height);
/// A torus around z; quads along its lines of curvature.
PolyMesh torus(Index n, Index m, double major, double minor);
/// The surface of the cube [-half, half]^3, n x n quads a side, outward.
PolyMesh cube(Index n, double half);
/// A band of n quads with half a twist.
PolyMesh moebius_band(Index n);

/// The mesh with every vertex moved.
PolyMesh moved(PolyMesh mesh, const std::function<Vec3(const Vec3&)>& move);
/// A mesh with every vertex displaced by up to `amount` along each axis, always in the same way.
PolyMesh shaken(PolyMesh mesh, double amount);

/// The mesh as a reference: triangulated, with topology, wedges and, where two faces bend by more
/// than `feature_angle_deg`, feature edges.
TriMesh reference(const PolyMesh& mesh, double feature_angle_deg = 180);

}  // namespace strake::shapes
