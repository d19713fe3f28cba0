#include "common/geometry/patch_fill/patch_outline.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>

namespace strake {
namespace {

using IsEdge = std::function<bool(Index, Index)>;
using Ring = std::vector<Index>;

/// Goes around all outlines. \param next  the vertex after each
std::vector<Ring> rings_of(std::map<Index, Index> next) {
  std::vector<Ring> rings;
  while (!next.empty()) {
    Ring ring;
    for (auto at = next.begin(); at != next.end(); at = next.find(ring.back())) {
      ring.push_back(at->second);
      next.erase(at);
    }
    std::rotate(ring.begin(), std::prev(ring.end()), ring.end());
    rings.push_back(std::move(ring));
  }
  return rings;
}

/// Adds what is left of a ring without its edges on the boundary.
void add_paths(const Ring& ring, const IsEdge& is_boundary, PatchOutline& outline) {
  const std::size_t n = ring.size();
  const auto is_left_out = [&](std::size_t i) {
    return is_boundary && is_boundary(ring[i % n], ring[(i + 1) % n]);
  };
  std::size_t first = 0;
  while (first < n && !is_left_out(first)) ++first;
  if (first == n) {
    outline.paths.push_back({ring, true});
    return;
  }
  bool is_all = true;
  for (std::size_t i = first; i < first + n; ++i) {
    if (is_left_out(i + 1)) continue;
    is_all = false;
    if (is_left_out(i)) outline.paths.push_back({{ring[(i + 1) % n]}, false});
    outline.paths.back().vertices.push_back(ring[(i + 2) % n]);
  }
  if (is_all) ++outline.boundary_loops;
}

Index closed_count(const PatchOutline& outline) {
  return static_cast<Index>(
      std::ranges::count(outline.paths, true, &PatchOutline::Path::is_closed));
}

}  // namespace

bool PatchOutline::is_disk() const {
  return euler == 1 && paths.size() == 1 && paths.front().is_closed &&
         paths.front().vertices.size() >= 3;
}

bool PatchOutline::is_like(const PatchOutline& other) const {
  return euler == other.euler && loops == other.loops && boundary_loops == other.boundary_loops &&
         paths.size() == other.paths.size() && closed_count(*this) == closed_count(other);
}

PatchOutline patch_outline(std::span<const std::vector<Index>> faces, const IsEdge& is_wall,
                           const IsEdge& is_boundary) {
  std::set<std::pair<Index, Index>> sides;
  for (const std::vector<Index>& face : faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      sides.emplace(face[i], face[(i + 1) % face.size()]);
    }
  }
  PatchOutline outline;
  std::set<Index> vertices;
  std::map<Index, Index> next;
  for (const auto& [a, b] : sides) {
    vertices.insert(a);
    if (sides.contains({b, a}) && !(is_wall && is_wall(a, b))) continue;
    if (!next.emplace(a, b).second) outline.pinched.push_back(a);
  }
  if (!outline.pinched.empty()) return outline;
  const std::size_t edges = (sides.size() + next.size()) / 2;  // inner ones have two sides
  outline.euler = static_cast<Index>(vertices.size() + faces.size()) - static_cast<Index>(edges);
  const std::vector<Ring> rings = rings_of(std::move(next));
  outline.loops = static_cast<Index>(rings.size());
  for (const Ring& ring : rings) add_paths(ring, is_boundary, outline);
  return outline;
}

}  // namespace strake
