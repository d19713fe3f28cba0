#include "stages/fit/mendable_crossings.h"

#include <set>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake::fitting {
namespace {

constexpr double kLargestShare = 0.1;
constexpr std::size_t kFewCrossings = 100;

}  // namespace

std::vector<std::array<Index, 2>> mendable_crossings(const PolyMesh& mesh,
                                                     const std::vector<Vec3>& positions) {
  auto pairs = find_crossing_faces(positions, triangulate_faces(mesh, positions));
  std::set<Index> faces;
  for (const auto& pair : pairs) faces.insert(pair.begin(), pair.end());
  if (pairs.size() > kFewCrossings &&
      static_cast<double>(faces.size()) > kLargestShare * static_cast<double>(mesh.face_count())) {
    pairs.clear();
  }
  return pairs;
}

}  // namespace strake::fitting
