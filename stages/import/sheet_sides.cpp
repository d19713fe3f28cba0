#include "stages/import/sheet_sides.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace strake::import {

SheetSides::SheetSides(const Soup& soup)
    : above_(soup.faces.size()),
      size_(soup.faces.size(), 1),
      is_turned_(soup.faces.size(), 0),
      is_one_sided_(soup.faces.size(), 0) {
  std::iota(above_.begin(), above_.end(), 0);
  const EdgeGroups groups(soup);
  std::vector<Joint> against;
  for (Index g = 0; g < groups.size(); ++g) {
    if (groups[g].size() != 2) continue;
    const auto [a, b] = std::pair(groups[g][0], groups[g][1]);
    const Joint joint{a / 3, b / 3, soup.from(a) != soup.from(b)};
    if (unite(joint) == kNone && !agrees(joint)) against.push_back(joint);
  }
  for (const Joint& joint : against) is_one_sided_[side_of(joint.face).sheet] = 1;
}

bool SheetSides::join(const std::vector<Joint>& joints) {
  const auto is_one_sided = [&](const Joint& joint) {
    return is_one_sided_[side_of(joint.face).sheet] != 0 ||
           is_one_sided_[side_of(joint.other).sheet] != 0;
  };
  if (std::any_of(joints.begin(), joints.end(), is_one_sided)) return false;
  std::vector<Index> joined;
  for (const Joint& joint : joints) {
    const Index part = unite(joint);
    if (part != kNone) joined.push_back(part);
    if (agrees(joint)) continue;
    for (; !joined.empty(); joined.pop_back()) {
      const Index last = joined.back();
      size_[above_[last]] -= size_[last];
      above_[last] = last;
      is_turned_[last] = 0;
    }
    return false;
  }
  return true;
}

SheetSides::Side SheetSides::side_of(Index face) const {
  bool is_turned = false;
  for (; above_[face] != face; face = above_[face]) is_turned ^= is_turned_[face] != 0;
  return {face, is_turned};
}

Index SheetSides::unite(const Joint& joint) {
  Side low = side_of(joint.face);
  Side high = side_of(joint.other);
  if (low.sheet == high.sheet) return kNone;
  if (size_[low.sheet] > size_[high.sheet]) std::swap(low, high);
  above_[low.sheet] = high.sheet;
  size_[high.sheet] += size_[low.sheet];
  is_turned_[low.sheet] = (low.is_turned != high.is_turned) == joint.is_alike ? 1 : 0;
  return low.sheet;
}

bool SheetSides::agrees(const Joint& joint) const {
  return (side_of(joint.face).is_turned == side_of(joint.other).is_turned) == joint.is_alike;
}

}  // namespace strake::import
