#include "stages/refine/surface_points.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/mesh_measures.h"
#include "stages/refine/way_split.h"

namespace strake {
namespace {

/// On an edge or at a vertex where barycentric coordinates are this near to 0 or 1.
constexpr double kOnEdge = 1e-9;
/// A way joins two points where it is at most this many times their distance.
constexpr double kLongestWay = 4;
/// Likewise along a feature or boundary line.
constexpr double kLongestLine = 2;

}  // namespace

Vec3 SurfacePoints::place(const LinePlace& at) const {
  const Vec3& a = mesh_.positions[mesh_.from(at.halfedge)];
  return a + at.lambda * (mesh_.positions[mesh_.to(at.halfedge)] - a);
}

SurfacePoints::SurfacePoints(const TriMesh& mesh)
    : mesh_(mesh), surface_(mesh.positions, mesh.faces), normals_(mesh) {}

SurfacePoint SurfacePoints::nearest(const Vec3& p, const Vec3& normal) const {
  const auto faces_alike = [&](Index face) { return normals_[face].dot(normal) > 0; };
  ClosestPoint found = surface_.closest_if(p, std::numeric_limits<double>::infinity(), faces_alike);
  if (found.triangle == kNone) found = surface_.closest(p);
  return {found.triangle, found.barycentric};
}

std::vector<SurfacePoints::LinePlace> SurfacePoints::on_lines(const SurfacePoint& point) const {
  std::vector<LinePlace> places;
  for (int i = 0; i < 3; ++i) {
    if (point.barycentric[i] < 1 - kOnEdge) continue;
    const Index first = mesh_.vertex_out[mesh_.faces[point.face][i]];
    for (Index h = first; h != kNone;) {
      if (mesh_.is_barrier(h)) places.push_back({h, 0});
      const Index in = TriMesh::prev(h);
      if (mesh_.is_boundary(in)) places.push_back({in, 1});
      h = mesh_.rotate_ccw(h);
      if (h == first) break;
    }
    return places;
  }
  for (int i = 0; i < 3; ++i) {
    const Index h = 3 * point.face + i;
    if (point.barycentric[(i + 2) % 3] >= kOnEdge || !mesh_.is_barrier(h)) continue;
    const double lambda = point.barycentric[(i + 1) % 3];
    places.push_back({h, lambda});
    if (!mesh_.is_boundary(h)) places.push_back({mesh_.twin[h], 1 - lambda});
  }
  return places;
}

Index SurfacePoints::next_on_line(Index h) const {
  const Index v = mesh_.to(h);
  if (mesh_.is_corner[v] != 0) return kNone;
  const Index first = mesh_.vertex_out[v];
  for (Index out = first; out != kNone;) {
    if (mesh_.is_barrier(out) && out != mesh_.twin[h]) return out;
    out = mesh_.rotate_ccw(out);
    if (out == first) break;
  }
  return kNone;
}

std::vector<SurfacePoints::LinePlace> SurfacePoints::way(const LinePlace& from,
                                                         const SurfacePoint& to,
                                                         double longest) const {
  const std::vector<LinePlace> ends = on_lines(to);
  std::vector<LinePlace> places = {from};
  double length = 0;
  LinePlace at = from;
  while (length <= longest) {
    const auto end = std::find_if(ends.begin(), ends.end(), [&](const LinePlace& e) {
      return e.halfedge == at.halfedge && e.lambda >= at.lambda;
    });
    if (end != ends.end()) {
      places.push_back(*end);
      return places;
    }
    const LinePlace tip{at.halfedge, 1};
    length += (place(tip) - place(at)).norm();
    places.push_back(tip);
    const bool ends_here = std::any_of(ends.begin(), ends.end(), [&](const LinePlace& e) {
      const Index v = e.lambda == 0   ? mesh_.from(e.halfedge)
                      : e.lambda == 1 ? mesh_.to(e.halfedge)
                                      : kNone;
      return v == mesh_.to(at.halfedge);
    });
    if (ends_here) return places;
    const Index next = next_on_line(at.halfedge);
    if (next == kNone) break;
    at = {next, 0};
  }
  return {};
}

SurfacePoint SurfacePoints::between(const SurfacePoint& a, const SurfacePoint& b,
                                    const Vec3& middle, const Vec3& normal) const {
  const double longest = kLongestWay * (place_of(mesh_, a) - place_of(mesh_, b)).norm();
  double shortest = kLongestLine * (place_of(mesh_, a) - place_of(mesh_, b)).norm();
  std::vector<LinePlace> best;
  const auto try_way = [&](const SurfacePoint& from, const SurfacePoint& to) {
    for (const LinePlace& start : on_lines(from)) {
      std::vector<LinePlace> found = way(start, to, longest);
      double length = 0;
      for (std::size_t i = 1; i < found.size(); ++i) {
        length += (place(found[i]) - place(found[i - 1])).norm();
      }
      if (found.size() < 2 || !(length > 0) || !(length < shortest)) continue;
      shortest = length;
      best = std::move(found);
    }
  };
  try_way(a, b);
  try_way(b, a);  // boundary half-edges have one sense only
  if (best.empty()) {
    const auto cut = split_of_section(mesh_, a, b, normal, longest);
    return cut ? *cut : nearest(middle, normal);
  }
  std::vector<Vec3> places;
  for (const LinePlace& at : best) places.push_back(place(at));
  const auto [piece, share] = split_of_way(places);
  // Where the half-edge changes, the piece lies on the next one.
  const LinePlace& end = best[piece + 1];
  const double start = best[piece].halfedge == end.halfedge ? best[piece].lambda : 0;
  const double lambda = start + share * (end.lambda - start);
  SurfacePoint point{TriMesh::face_of(end.halfedge), {0, 0, 0}};
  point.barycentric[end.halfedge % 3] = 1 - lambda;
  point.barycentric[(end.halfedge + 1) % 3] = lambda;
  return point;
}

}  // namespace strake
