#include "common/geometry/cell_error/compared_surfaces.h"

#include <utility>

namespace strake {
namespace {

std::vector<Vec3> moved(std::vector<Vec3> positions, const Vec3& origin) {
  for (Vec3& p : positions) p -= origin;
  return positions;
}

}  // namespace

ComparedSurfaces::ComparedSurfaces(std::shared_ptr<const InputSurface> input, const QuadMesh& quads)
    : input_(std::move(input)),
      quads_(quads),
      triangles_(triangulate_faces(quads.mesh)),
      first_(static_cast<std::size_t>(quads.mesh.face_count()) + 1, 0),
      positions_(moved(quads.mesh.positions, input_->mesh.origin)),
      result_(positions_, triangles_.corners) {
  for (const Index f : triangles_.face) ++first_[f + 1];
  for (std::size_t f = 1; f < first_.size(); ++f) first_[f] += first_[f - 1];
}

}  // namespace strake
