#include "common/geometry/patch_fill/patch_outline.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace strake {
namespace {

using IsEdge = std::function<bool(Index, Index)>;
using Ring = std::vector<Index>;

/// An edge in the sense of a face to its left.
using Side = std::pair<Index, Index>;

/// Goes around all outlines, beginning at the least vertex of each.
/// \param outline  ascending, one from each vertex
std::vector<Ring> rings_of(const std::vector<Side>& outline) {
  std::vector<Ring> rings;
  std::vector<bool> is_done(outline.size(), false);
  const auto side_from = [&](Index vertex) {
    const auto at = std::ranges::lower_bound(outline, vertex, {}, &Side::first);
    const bool is_there = at != outline.end() && at->first == vertex;
    return is_there ? static_cast<std::size_t>(at - outline.begin()) : outline.size();
  };
  for (std::size_t first = 0; first < outline.size(); ++first) {
    if (is_done[first]) continue;
    Ring ring;
    for (std::size_t i = first; i < outline.size() && !is_done[i]; i = side_from(ring.back())) {
      ring.push_back(outline[i].second);
      is_done[i] = true;
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
  std::vector<Side> sides;
  for (const std::vector<Index>& face : faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      sides.emplace_back(face[i], face[(i + 1) % face.size()]);
    }
  }
  std::sort(sides.begin(), sides.end());
  sides.erase(std::unique(sides.begin(), sides.end()), sides.end());
  PatchOutline outline;
  std::size_t vertices = 0;
  std::vector<Side> around;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const auto& [a, b] = sides[i];
    vertices += i == 0 || sides[i - 1].first != a ? 1 : 0;
    const bool has_both = std::binary_search(sides.begin(), sides.end(), Side{b, a});
    if (has_both && !(is_wall && is_wall(a, b))) continue;
    if (!around.empty() && around.back().first == a) {
      outline.pinched.push_back(a);
    } else {
      around.emplace_back(a, b);
    }
  }
  if (!outline.pinched.empty()) return outline;
  const std::size_t edges = (sides.size() + around.size()) / 2;  // inner ones have two sides
  outline.euler = static_cast<Index>(vertices + faces.size()) - static_cast<Index>(edges);
  const std::vector<Ring> rings = rings_of(around);
  outline.loops = static_cast<Index>(rings.size());
  for (const Ring& ring : rings) add_paths(ring, is_boundary, outline);
  return outline;
}

}  // namespace strake
