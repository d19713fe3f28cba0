#include "common/geometry/surface_lines.h"

#include <algorithm>
#include <utility>

#include "common/geometry/topology/vertex_ring.h"

namespace strake {

Vec3 SurfaceLines::position(const Place& at) const {
  const Vec3& a = mesh_.positions[mesh_.from(at.halfedge)];
  return a + at.lambda * (mesh_.positions[mesh_.to(at.halfedge)] - a);
}

std::vector<SurfaceLines::Place> SurfaceLines::places(const SurfacePoint& point) const {
  std::vector<Place> found;
  const Index corner = corner_at(point);
  if (corner != kNone) {
    for_each_outgoing(mesh_, mesh_.from(corner), [&](Index h) {
      if (mesh_.is_barrier(h)) found.push_back({h, 0});
      const Index in = TriMesh::prev(h);
      if (mesh_.is_boundary(in)) found.push_back({in, 1});
    });
    return found;
  }
  for (Index h = 3 * point.face; h < 3 * point.face + 3; ++h) {
    if (!is_on_edge(point, h) || !mesh_.is_barrier(h)) continue;
    const double lambda = share_along(point, h);
    found.push_back({h, lambda});
    if (!mesh_.is_boundary(h)) found.push_back({mesh_.twin[h], 1 - lambda});
  }
  return found;
}

bool SurfaceLines::is_corner(const SurfacePoint& point) const {
  const Index corner = corner_at(point);
  return corner != kNone && mesh_.is_corner[mesh_.from(corner)] != 0;
}

Index SurfaceLines::next_on_line(Index h) const {
  const Index v = mesh_.to(h);
  if (mesh_.is_corner[v] != 0) return kNone;
  return find_outgoing(mesh_, v,
                       [&](Index out) { return mesh_.is_barrier(out) && out != mesh_.twin[h]; });
}

std::vector<SurfaceLines::Place> SurfaceLines::way(const Place& from, const SurfacePoint& to,
                                                   double longest) const {
  const std::vector<Place> ends = places(to);
  std::vector<Place> passed = {from};
  double length = 0;
  Place at = from;
  while (length <= longest) {
    const auto end = std::find_if(ends.begin(), ends.end(), [&](const Place& e) {
      return e.halfedge == at.halfedge && e.lambda >= at.lambda;
    });
    if (end != ends.end()) {
      passed.push_back(*end);
      return passed;
    }
    const Place tip{at.halfedge, 1};
    length += (position(tip) - position(at)).norm();
    passed.push_back(tip);
    const bool ends_here = std::any_of(ends.begin(), ends.end(), [&](const Place& e) {
      const Index v = e.lambda == 0   ? mesh_.from(e.halfedge)
                      : e.lambda == 1 ? mesh_.to(e.halfedge)
                                      : kNone;
      return v == mesh_.to(at.halfedge);
    });
    if (ends_here) return passed;
    const Index next = next_on_line(at.halfedge);
    const bool is_around = at.halfedge == from.halfedge && passed.size() > 2;
    if (next == kNone || is_around) break;  // a loop of no length would have no end
    at = {next, 0};
  }
  return {};
}

std::vector<SurfaceLines::Place> SurfaceLines::way_between(const SurfacePoint& a,
                                                           const SurfacePoint& b,
                                                           double longest) const {
  double shortest = longest;
  std::vector<Place> best;
  const auto try_way = [&](const SurfacePoint& from, const SurfacePoint& to) {
    for (const Place& start : places(from)) {
      std::vector<Place> found = way(start, to, longest);
      double length = 0;
      for (std::size_t i = 1; i < found.size(); ++i) {
        length += (position(found[i]) - position(found[i - 1])).norm();
      }
      if (found.size() < 2 || !(length > 0) || !(length < shortest)) continue;
      shortest = length;
      best = std::move(found);
    }
  };
  try_way(a, b);
  try_way(b, a);  // boundary half-edges have one sense only
  return best;
}

bool SurfaceLines::has_along(const SurfacePoint& a, const SurfacePoint& b) const {
  const double distance = (place_of(mesh_, a) - place_of(mesh_, b)).norm();
  return !way_between(a, b, kLongestLine * distance).empty();
}

}  // namespace strake
