#include "strake/chain/facet_height.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <tuple>
#include <vector>

#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

/// Vertices wanted, in those of the mesh, from which on edges of facets are features, and from
/// which on low ones are, too, which take vertices from the rest where there are few.
constexpr double kFrom = 1.2;
constexpr double kLowFrom = 2;
/// Heights of both, in lengths of mean cells.
constexpr double kHeight = 0.03;
constexpr double kLow = 0.003;

/// Number of vertices, those at one place counted once.
std::size_t count_places(const PolyMesh& mesh) {
  std::vector<Vec3> places;
  std::ranges::copy_if(mesh.positions, std::back_inserter(places),
                       [](const Vec3& p) { return p.allFinite(); });
  std::ranges::sort(places, {}, [](const Vec3& p) { return std::tuple(p.x(), p.y(), p.z()); });
  return static_cast<std::size_t>(std::unique(places.begin(), places.end()) - places.begin());
}

/// Area of the faces of a mesh as read, leaving out those that are none.
double area_of(const PolyMesh& mesh) {
  double area = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::span<const Index> face = mesh.face(f);
    const bool is_face = face.size() > 2 && std::ranges::all_of(face, [&](Index v) {
                           return v >= 0 && v < mesh.vertex_count();
                         });
    if (!is_face) continue;
    const Vec3 normal = newell_normal(mesh.positions, face);
    if (normal.allFinite()) area += normal.norm() / 2;
  }
  return area;
}

}  // namespace

std::optional<Length> facet_height(const PolyMesh& mesh, double diagonal, double wanted) {
  // Soups have six copies of each vertex. Large meshes need no more than this.
  constexpr double kMostCopies = 16;
  if (wanted < kFrom * mesh.vertex_count() / kMostCopies) return std::nullopt;
  const double times = wanted / static_cast<double>(count_places(mesh));
  const double area = area_of(mesh);
  if (times < kFrom || !(area > 0) || !(diagonal > 0)) return std::nullopt;
  const double cell = std::sqrt(area / wanted) / diagonal;
  const double height = (times < kLowFrom ? kHeight : kLow) * cell;
  constexpr double kLeast = 1e-6;  // that import takes
  return Length{std::clamp(height, kLeast, 1.0), true};
}

}  // namespace strake
