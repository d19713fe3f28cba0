#include "common/geometry/patch_fill/disk_outline.h"

#include <map>
#include <set>
#include <utility>

namespace strake {

DiskOutline disk_outline(std::span<const std::vector<Index>> faces,
                         const std::function<bool(Index, Index)>& is_wall) {
  std::set<std::pair<Index, Index>> sides;
  for (const std::vector<Index>& face : faces) {
    for (std::size_t i = 0; i < face.size(); ++i) {
      sides.emplace(face[i], face[(i + 1) % face.size()]);
    }
  }
  DiskOutline outline;
  std::set<Index> vertices;
  std::map<Index, Index> next;
  for (const auto& [a, b] : sides) {
    vertices.insert(a);
    if (sides.contains({b, a}) && !(is_wall && is_wall(a, b))) continue;
    if (!next.emplace(a, b).second) outline.pinched.push_back(a);
  }
  if (!outline.pinched.empty() || next.empty()) return outline;
  std::vector<Index> ring = {next.begin()->first};
  while (ring.size() <= next.size()) {
    const auto following = next.find(ring.back());
    if (following == next.end()) return outline;
    if (following->second == ring.front()) break;
    ring.push_back(following->second);
  }
  if (ring.size() != next.size() || ring.size() < 3) return outline;
  // One outline does not make it a disk: it may have handles. Inner edges have two sides.
  const std::size_t edges = (sides.size() + ring.size()) / 2;
  if (vertices.size() + faces.size() == edges + 1) outline.ring = std::move(ring);
  return outline;
}

}  // namespace strake
