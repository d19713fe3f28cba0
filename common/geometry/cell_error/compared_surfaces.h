#pragma once

#include <array>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {

/// A result beside the surface it approximates, both in the coordinates of the surface.
class ComparedSurfaces {
 public:
  /// \param mesh, quads  kept by reference. \pre `quads` was made from `mesh`
  ComparedSurfaces(const TriMesh& mesh, const QuadMesh& quads);

  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }
  [[nodiscard]] const PolyMesh& faces() const { return quads_.mesh; }
  /// [V of the result] relative to the mesh's origin.
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  /// The result's triangles, each with its face.
  [[nodiscard]] const FaceTriangles& triangles() const { return triangles_; }
  /// First triangle of a face of the result; of the face after the last one, their number.
  [[nodiscard]] Index first_triangle(Index face) const { return first_[face]; }

  [[nodiscard]] const SurfaceDistance& input() const { return input_; }
  [[nodiscard]] const SurfaceDistance& result() const { return result_; }
  [[nodiscard]] const FaceNormals& input_normals() const { return input_normals_; }

 private:
  const TriMesh& mesh_;
  const QuadMesh& quads_;
  FaceTriangles triangles_;
  std::vector<Index> first_;
  std::vector<Vec3> positions_;
  SurfaceDistance input_;
  SurfaceDistance result_;
  FaceNormals input_normals_;
};

}  // namespace strake
