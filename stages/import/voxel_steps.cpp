#include "stages/import/voxel_steps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/geometry/mesh_measures.h"

namespace strake::import {
namespace {

/// Fewer layers may be those of anything.
constexpr std::size_t kFewestLayers = 8;
/// Vertices to a layer, in the mean: a surface crosses each of them along a line.
constexpr std::size_t kFewestInLayer = 4;
/// Share of layers that may have no vertex, where parts of a volume lie apart.
constexpr double kMostEmpty = 0.3;
/// Coordinates may be off their layer by this share of the distance of layers, as written in text.
constexpr double kOff = 1e-3;

/// Edges that are bent by more may be those of steps, whose bends are 35 to 90 degrees: cosine.
constexpr double kBent = 0.9;
/// Share of the edges that are, by length, and of these that are bent to either side.
constexpr double kFewestBent = 0.05;
constexpr double kFewestEitherWay = 0.2;

/// The coordinates that vertices have along an axis, ascending, each once.
std::vector<double> layers_along(const TriMesh& mesh, int axis) {
  std::vector<double> at;
  at.reserve(mesh.positions.size());
  for (const Vec3& p : mesh.positions) at.push_back(p[axis]);
  std::sort(at.begin(), at.end());
  const double rounding = 1e-7 * mesh.diagonal;
  const auto is_same = [&](double a, double b) { return b - a <= rounding; };
  at.erase(std::unique(at.begin(), at.end(), is_same), at.end());
  return at;
}

bool lies_in_layers(const TriMesh& mesh, int axis) {
  const std::vector<double> layers = layers_along(mesh, axis);
  const std::size_t count = layers.size();
  if (count < kFewestLayers || count * kFewestInLayer > mesh.positions.size()) return false;
  std::vector<double> gaps;
  for (std::size_t i = 1; i < count; ++i) gaps.push_back(layers[i] - layers[i - 1]);
  const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
  std::nth_element(gaps.begin(), middle, gaps.end());
  const double steps = std::round((layers.back() - layers.front()) / *middle);
  if (static_cast<double>(count) < (1 - kMostEmpty) * steps) return false;
  const double pitch = (layers.back() - layers.front()) / steps;
  return std::ranges::all_of(layers, [&](double at) {
    const double step = (at - layers.front()) / pitch;
    return std::abs(step - std::round(step)) <= kOff;
  });
}

/// Whether many edges are bent, and to both sides.
bool goes_up_and_down(const TriMesh& mesh) {
  const FaceNormals normals(mesh);
  double length = 0;
  double convex = 0;
  double concave = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || h > twin) continue;
    const Vec3 along = mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
    length += along.norm();
    const Vec3 left = normals[TriMesh::face_of(h)];
    const Vec3 right = normals[TriMesh::face_of(twin)];
    if (left.dot(right) >= kBent) continue;
    (left.cross(right).dot(along) > 0 ? convex : concave) += along.norm();
  }
  const double bent = convex + concave;
  return bent >= kFewestBent * length && std::min(convex, concave) >= kFewestEitherWay * bent;
}

}  // namespace

bool has_voxel_steps(const TriMesh& mesh) {
  return lies_in_layers(mesh, 0) && lies_in_layers(mesh, 1) && lies_in_layers(mesh, 2) &&
         goes_up_and_down(mesh);
}

}  // namespace strake::import
