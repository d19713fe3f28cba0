#pragma once

#include <array>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake {

/// The vector area of a polygon times two (Newell): along its normal, counter-clockwise seen from
/// its tip. Zero for a polygon without area.
/// \param positions  any length unit
/// \param face       at least 3 vertices
Vec3 newell_normal(std::span<const Vec3> positions, std::span<const Index> face);

/// Whether a corner of the polygon turns against its Newell normal: by more than 1e-9 of the
/// product of the two edge lengths at the corner.
bool is_concave_face(std::span<const Vec3> positions, std::span<const Index> face);

/// Share of the faces that have an angle below 10 degrees, or a side without length; 0 of none.
double thin_face_share(const PolyMesh& mesh);

/// Splits a polygon into `face.size() - 2` triangles with its orientation, for measuring and
/// drawing.
///
/// A quad is split along the diagonal whose two triangles both face along its normal, the shorter
/// one where both or neither do. A larger polygon is cut ear by ear, the best shaped ear first; one
/// that crosses itself ends as a fan. Polygons with fewer than 3 corners give nothing.
/// \param triangles  appended to
/// Cost O(n^3) for n corners (a handful). Beyond 256 corners the first ear found is cut instead of
/// the best shaped: O(n^2) as a rule.
void triangulate_face(std::span<const Vec3> positions, std::span<const Index> face,
                      std::vector<std::array<Index, 3>>& triangles);

/// A polygon mesh as triangles, each with the face it is part of.
struct FaceTriangles {
  std::vector<std::array<Index, 3>> corners;  ///< [T] vertices of the mesh
  std::vector<Index> face;                    ///< [T] ascending
};

/// Splits every face of a mesh by `triangulate_face`.
FaceTriangles triangulate_faces(const PolyMesh& mesh);
/// Likewise, with its vertices elsewhere. \param positions  [V]
FaceTriangles triangulate_faces(const PolyMesh& mesh, std::span<const Vec3> positions);

/// What rounding alone could make of `triangulate_faces`, where it gives anything else: faces with
/// a corner on the straight line between two others, or diagonals of equal length, may be cut
/// otherwise by another program, or after the mesh is moved. Not every mixture of the cases.
std::vector<FaceTriangles> other_triangulations(const PolyMesh& mesh);

/// Turns the corners of faces so that a fan from the first one has the triangles of
/// `triangulate_face`, where these are a fan: always up to five corners. So programs that cut faces
/// into fans see the surface that is measured here. Texture coordinates belong to corners and are
/// not turned with them: carry them over afterwards (carry_attributes.h).
void begin_faces_at_fans(PolyMesh& mesh);

}  // namespace strake
