#include "common/geometry/patch_fill/mendable_crossings.h"

#include <algorithm>
#include <set>

#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

constexpr double kLargestShare = 0.1;
constexpr std::size_t kFewCrossings = 100;
constexpr std::size_t kMostCrossings = 5000;

}  // namespace

std::vector<std::array<Index, 2>> mendable_crossings(const PolyMesh& mesh,
                                                     const std::vector<Vec3>& positions) {
  auto pairs = find_crossing_faces(positions, triangulate_faces(mesh, positions));
  std::set<Index> faces;
  for (const auto& pair : pairs) faces.insert(pair.begin(), pair.end());
  const double share = static_cast<double>(faces.size()) /
                       static_cast<double>(std::max(Index{1}, mesh.face_count()));
  if (pairs.size() > kMostCrossings || (pairs.size() > kFewCrossings && share > kLargestShare)) {
    pairs.clear();
  }
  return pairs;
}

}  // namespace strake
