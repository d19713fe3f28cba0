#pragma once

#include <array>
#include <memory>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {

/// A surface that results are compared with, and what that takes: made once for all of them.
struct InputSurface {
  /// \param surface  kept by reference
  explicit InputSurface(const TriMesh& surface)
      : mesh(surface), distance(surface.positions, surface.faces), normals(surface) {}

  const TriMesh& mesh;
  SurfaceDistance distance;
  FaceNormals normals;
};

/// A result beside the surface it approximates, both in the coordinates of the surface.
class ComparedSurfaces {
 public:
  /// \param quads  kept by reference. \pre it was made from the mesh of `input`
  ComparedSurfaces(std::shared_ptr<const InputSurface> input, const QuadMesh& quads);
  ComparedSurfaces(const TriMesh& mesh, const QuadMesh& quads)
      : ComparedSurfaces(std::make_shared<const InputSurface>(mesh), quads) {}

  [[nodiscard]] const std::shared_ptr<const InputSurface>& shared_input() const { return input_; }
  [[nodiscard]] const TriMesh& mesh() const { return input_->mesh; }
  [[nodiscard]] const PolyMesh& faces() const { return quads_.mesh; }
  /// [V of the result] relative to the mesh's origin.
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  /// The result's triangles, each with its face.
  [[nodiscard]] const FaceTriangles& triangles() const { return triangles_; }
  /// First triangle of a face of the result; of the face after the last one, their number.
  [[nodiscard]] Index first_triangle(Index face) const { return first_[face]; }

  [[nodiscard]] const SurfaceDistance& input() const { return input_->distance; }
  [[nodiscard]] const SurfaceDistance& result() const { return result_; }
  [[nodiscard]] const FaceNormals& input_normals() const { return input_->normals; }

 private:
  std::shared_ptr<const InputSurface> input_;
  const QuadMesh& quads_;
  FaceTriangles triangles_;
  std::vector<Index> first_;
  std::vector<Vec3> positions_;
  SurfaceDistance result_;
};

}  // namespace strake
