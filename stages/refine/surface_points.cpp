#include "stages/refine/surface_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <numbers>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/chain_corners.h"
#include "common/geometry/mesh_measures.h"
#include "stages/refine/section_path.h"
#include "stages/refine/way_split.h"

namespace strake {
namespace {

/// A way joins two points where it is at most this many times their distance.
constexpr double kLongestWay = 4;

/// A jagged boundary turns by at least this much, radians, to both sides. Where it turns by less,
/// dividing an edge in the middle leaves better cells, and nothing that lies across what follows.
constexpr double kJagTurn = std::numbers::pi / 3;

}  // namespace

SurfacePoints::SurfacePoints(const TriMesh& mesh)
    : mesh_(mesh),
      lines_(mesh),
      boundary_(mesh),
      surface_(mesh.positions, mesh.faces),
      normals_(mesh),
      components_(mesh) {}

SurfacePoint SurfacePoints::nearest(const Vec3& p, const Vec3& normal, double reach,
                                    Index own) const {
  const auto is_own = [&](Index face) { return components_.has_both(face, own); };
  const auto faces_alike = [&](Index face) {
    return normals_[face].dot(normal) > 0 && is_own(face);
  };
  ClosestPoint found = surface_.closest_if(p, reach, faces_alike);
  if (found.triangle == kNone) {
    found = surface_.closest_if(p, std::numeric_limits<double>::infinity(), is_own);
  }
  return {found.triangle, found.barycentric};
}

SurfacePoint SurfacePoints::between(const SurfacePoint& a, const SurfacePoint& b,
                                    const Vec3& middle, const Vec3& normal) const {
  const double distance = (place_of(mesh_, a) - place_of(mesh_, b)).norm();
  const std::vector<SurfaceLines::Place> line =
      lines_.way_between(a, b, SurfaceLines::kLongestLine * distance);
  if (!line.empty() && !mesh_.is_boundary(line.back().halfedge)) return split_of(line);
  const auto cut = split_of_section(mesh_, a, b, normal, kLongestWay * distance);
  if (cut) return *cut;
  // The ends are on the sheet that is meant. What faces the same way farther off is another one:
  // the normal is that of a sliver across a notch of the boundary, which is turned over.
  const double reach =
      std::max((place_of(mesh_, a) - middle).norm(), (place_of(mesh_, b) - middle).norm());
  return nearest(middle, normal, reach, a.face);
}

std::optional<SurfacePoint> SurfacePoints::between_on_boundary(const SurfacePoint& from,
                                                               const SurfacePoint& to) const {
  const std::vector<SurfaceLines::Place> line = boundary_.way(from, to);
  if (line.size() < 2) return std::nullopt;
  return split_of(line);
}

std::vector<SurfacePoint> SurfacePoints::jags_between(const SurfacePoint& from,
                                                      const SurfacePoint& to, const Vec3& normal,
                                                      double within) const {
  const std::vector<SurfaceLines::Place> line = boundary_.way(from, to);
  const std::vector<Vec3> places = positions(line);
  const std::vector<std::size_t> corners = corners_of_chain(places, within);
  bool turns_left = false;
  bool turns_right = false;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3& p = places[corners[i]];
    const Vec3& before = i > 0 ? places[corners[i - 1]] : places.front();
    const Vec3& after = i + 1 < corners.size() ? places[corners[i + 1]] : places.back();
    if (angle_between(p - before, after - p) < kJagTurn) continue;
    const bool is_left = (p - before).cross(after - p).dot(normal) > 0;
    turns_left = turns_left || is_left;
    turns_right = turns_right || !is_left;
  }
  std::vector<SurfacePoint> jags;
  if (!turns_left || !turns_right) return jags;
  for (const std::size_t i : corners) jags.push_back(point_along(line[i].halfedge, line[i].lambda));
  return jags;
}

double SurfacePoints::boundary_height(const SurfacePoint& from, const SurfacePoint& to) const {
  return height_of_way(positions(boundary_.way(from, to)));
}

SurfacePoint SurfacePoints::split_of(const std::vector<SurfaceLines::Place>& line) const {
  const auto [piece, share] = split_of_way(positions(line));
  // Where the half-edge changes, the piece lies on the next one.
  const SurfaceLines::Place& end = line[piece + 1];
  const double start = line[piece].halfedge == end.halfedge ? line[piece].lambda : 0;
  return point_along(end.halfedge, start + share * (end.lambda - start));
}

std::vector<Vec3> SurfacePoints::positions(const std::vector<SurfaceLines::Place>& line) const {
  std::vector<Vec3> places;
  for (const SurfaceLines::Place& at : line) places.push_back(lines_.position(at));
  return places;
}

}  // namespace strake
