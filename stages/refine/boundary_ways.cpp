#include "stages/refine/boundary_ways.h"

#include <algorithm>

#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// An edge stands for a way of at most this many times its length, even where that is more than
/// half of the loop.
constexpr double kLongestWay = 2;

}  // namespace

BoundaryWays::BoundaryWays(const TriMesh& mesh)
    : mesh_(mesh), loop_(mesh.twin.size(), kNone), until_(mesh.twin.size(), 0) {
  for (Index start = 0; start < static_cast<Index>(mesh.twin.size()); ++start) {
    if (!mesh.is_boundary(start) || loop_[start] != kNone) continue;
    double sum = 0;
    for (Index h = start; loop_[h] == kNone; h = mesh.vertex_out[mesh.to(h)]) {
      loop_[h] = static_cast<Index>(lengths_.size());
      until_[h] = sum;
      sum += edge_length(mesh_, h);
    }
    lengths_.push_back(sum);
  }
}

std::vector<SurfaceLines::Place> BoundaryWays::way(const SurfacePoint& from,
                                                   const SurfacePoint& to) const {
  const SurfaceLines::Place start = place(from);
  const SurfaceLines::Place end = place(to);
  if (start.halfedge == kNone || end.halfedge == kNone) return {};
  const Index loop = loop_[start.halfedge];
  if (loop_[end.halfedge] != loop) return {};
  double length = position_on_loop(end) - position_on_loop(start);
  if (length < 0) length += lengths_[loop];
  const double distance = (place_of(mesh_, from) - place_of(mesh_, to)).norm();
  if (!(length > 0) || length > std::max(lengths_[loop] / 2, kLongestWay * distance)) return {};
  std::vector<SurfaceLines::Place> passed = {start};
  Index h = start.halfedge;
  if (h != end.halfedge || start.lambda > end.lambda) {
    do {
      passed.push_back({h, 1});
      h = mesh_.vertex_out[mesh_.to(h)];
    } while (h != end.halfedge);
  }
  if (end.lambda > 0) passed.push_back(end);
  return passed;
}

SurfaceLines::Place BoundaryWays::place(const SurfacePoint& point) const {
  const Index corner = corner_at(point);
  if (corner != kNone) {
    const Index h = mesh_.vertex_out[mesh_.from(corner)];
    return mesh_.is_boundary(h) ? SurfaceLines::Place{h, 0} : SurfaceLines::Place{};
  }
  const Index h = edge_at(point, [&](Index side) { return mesh_.is_boundary(side); });
  return h != kNone ? SurfaceLines::Place{h, share_along(point, h)} : SurfaceLines::Place{};
}

double BoundaryWays::position_on_loop(const SurfaceLines::Place& place) const {
  return until_[place.halfedge] + place.lambda * edge_length(mesh_, place.halfedge);
}

}  // namespace strake
