#include "stages/refine/surface_points.h"

#include <limits>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "stages/refine/section_path.h"
#include "stages/refine/way_split.h"

namespace strake {
namespace {

/// A way joins two points where it is at most this many times their distance.
constexpr double kLongestWay = 4;
/// Likewise along a feature or boundary line.
constexpr double kLongestLine = 2;

}  // namespace

SurfacePoints::SurfacePoints(const TriMesh& mesh)
    : mesh_(mesh), lines_(mesh), surface_(mesh.positions, mesh.faces), normals_(mesh) {}

SurfacePoint SurfacePoints::nearest(const Vec3& p, const Vec3& normal) const {
  const auto faces_alike = [&](Index face) { return normals_[face].dot(normal) > 0; };
  ClosestPoint found = surface_.closest_if(p, std::numeric_limits<double>::infinity(), faces_alike);
  if (found.triangle == kNone) found = surface_.closest(p);
  return {found.triangle, found.barycentric};
}

SurfacePoint SurfacePoints::between(const SurfacePoint& a, const SurfacePoint& b,
                                    const Vec3& middle, const Vec3& normal) const {
  const double distance = (place_of(mesh_, a) - place_of(mesh_, b)).norm();
  const std::vector<SurfaceLines::Place> line = lines_.way_between(a, b, kLongestLine * distance);
  if (line.empty()) {
    const auto cut = split_of_section(mesh_, a, b, normal, kLongestWay * distance);
    return cut ? *cut : nearest(middle, normal);
  }
  std::vector<Vec3> places;
  for (const SurfaceLines::Place& at : line) places.push_back(lines_.position(at));
  const auto [piece, share] = split_of_way(places);
  // Where the half-edge changes, the piece lies on the next one.
  const SurfaceLines::Place& end = line[piece + 1];
  const double start = line[piece].halfedge == end.halfedge ? line[piece].lambda : 0;
  const double lambda = start + share * (end.lambda - start);
  SurfacePoint point{TriMesh::face_of(end.halfedge), {0, 0, 0}};
  point.barycentric[end.halfedge % 3] = 1 - lambda;
  point.barycentric[(end.halfedge + 1) % 3] = lambda;
  return point;
}

}  // namespace strake
