#include "common/geometry/cell_error/compared_surfaces.h"

namespace strake {
namespace {

std::vector<Vec3> moved(std::vector<Vec3> positions, const Vec3& origin) {
  for (Vec3& p : positions) p -= origin;
  return positions;
}

}  // namespace

ComparedSurfaces::ComparedSurfaces(const TriMesh& mesh, const QuadMesh& quads)
    : mesh_(mesh),
      quads_(quads),
      triangles_(triangulate_faces(quads.mesh)),
      first_(static_cast<std::size_t>(quads.mesh.face_count()) + 1, 0),
      positions_(moved(quads.mesh.positions, mesh.origin)),
      input_(mesh.positions, mesh.faces),
      result_(positions_, triangles_.corners),
      input_normals_(mesh) {
  for (const Index f : triangles_.face) ++first_[f + 1];
  for (std::size_t f = 1; f < first_.size(); ++f) first_[f] += first_[f - 1];
}

}  // namespace strake
