#pragma once

#include <cstddef>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake {

double edge_length(const TriMesh& mesh, Index halfedge);

/// Whether a face has an area to speak of, and so a normal that is not taken from its neighbours.
bool has_own_normal(const TriMesh& mesh, Index face);

/// Unit normals of faces, computed when asked for: kept, they would take a third of the memory of
/// the mesh. A face without area takes the normal of its neighbours across its longest edges, so
/// that slivers neither bend the surface nor turn over.
class FaceNormals {
 public:
  /// \param mesh  kept by reference
  explicit FaceNormals(const TriMesh& mesh);

  [[nodiscard]] Vec3 operator[](Index face) const {
    if (!slivers_.empty() && !has_own_normal(*mesh_, face)) return of_sliver(face);
    return own(face);
  }
  /// [F] All of them, to be looked up often.
  [[nodiscard]] std::vector<Vec3> all() const;

 private:
  [[nodiscard]] Vec3 own(Index face) const;
  [[nodiscard]] Vec3 of_sliver(Index face) const;
  [[nodiscard]] std::size_t place_of_sliver(Index face) const;  ///< among all of them

  const TriMesh* mesh_;
  std::vector<Index> slivers_;        ///< ascending
  std::vector<Vec3> sliver_normals_;  ///< of those; zero while not known
};

/// [W] unit normals, angle-weighted over the faces of each wedge.
std::vector<Vec3> wedge_normals(const TriMesh& mesh, const FaceNormals& face_normals);

/// [W] a third of the area of each wedge's faces.
std::vector<double> wedge_areas(const TriMesh& mesh);

/// Of all faces.
double surface_area(const TriMesh& mesh);

/// Angle at corner h of its face, radians in [0, pi].
double corner_angle(const TriMesh& mesh, Index h);

}  // namespace strake
