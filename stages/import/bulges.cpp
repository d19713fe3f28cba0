#include "stages/import/bulges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace strake::import {
namespace {

/// The circle through three vertices one after the other, over the chord of the last two.
Bulge bulge_over(const Vec3& before, const Vec3& from, const Vec3& to) {
  constexpr double kCorner = 0.82;  // cosine of 35 degrees
  const Vec3 last = from - before;
  const Vec3 chord = to - from;
  const double length = chord.norm();
  if (!(last.dot(chord) >= kCorner * last.norm() * length)) return {};
  const Vec3 outward = last - last.dot(chord) / (length * length) * chord;
  const double twice_area = last.cross(chord).norm();
  if (!(twice_area > 0)) return {};
  const double radius = last.norm() * length * (to - before).norm() / (2 * twice_area);
  const double half = length / 2;
  const double height =
      half * half / (radius + std::sqrt(std::max(0.0, radius * radius - half * half)));
  return {outward.stableNormalized(), height};
}

}  // namespace

std::vector<Bulge> find_bulges(const Soup& soup, const std::vector<Index>& border) {
  std::vector<std::pair<Index, Index>> ends;  // a vertex and the other end of an edge there
  ends.reserve(2 * border.size());
  for (const Index h : border) {
    ends.emplace_back(soup.from(h), soup.to(h));
    ends.emplace_back(soup.to(h), soup.from(h));
  }
  std::sort(ends.begin(), ends.end());
  const auto before = [&](Index from, Index to) {
    const auto first = std::lower_bound(ends.begin(), ends.end(), std::pair(from, Index{0}));
    const auto is_at = [&](auto end) { return end < ends.end() && end->first == from; };
    if (!is_at(first + 1) || is_at(first + 2)) return kNone;
    return first->second == to ? (first + 1)->second : first->second;
  };
  std::vector<Bulge> bulges;
  bulges.reserve(border.size());
  for (const Index h : border) {
    Bulge& largest = bulges.emplace_back();
    for (const auto& [from, to] :
         {std::pair(soup.from(h), soup.to(h)), std::pair(soup.to(h), soup.from(h))}) {
      const Index next = before(from, to);
      if (next == kNone) continue;
      const Bulge bulge =
          bulge_over(soup.positions[next], soup.positions[from], soup.positions[to]);
      if (bulge.height > largest.height) largest = bulge;
    }
  }
  return bulges;
}

}  // namespace strake::import
