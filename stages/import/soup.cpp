#include "stages/import/soup.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <utility>

#include "common/core/disjoint_sets.h"

namespace strake::import {
namespace {

struct BucketEntry {
  Index key;
  Index item;
};

/// Sorts items 0 .. count - 1 by (primary, secondary, item), where `key(i)` gives the first two and
/// the primary key is in [0, buckets).
template <typename Key>
std::vector<BucketEntry> bucket_sort(Index buckets, Index count, const Key& key,
                                     std::vector<Index>& offsets) {
  offsets.assign(static_cast<std::size_t>(buckets) + 2, 0);
  for (Index i = 0; i < count; ++i) ++offsets[key(i).first + 2];
  std::partial_sum(offsets.begin(), offsets.end(), offsets.begin());
  std::vector<BucketEntry> entries(count);
  for (Index i = 0; i < count; ++i) {
    const auto [primary, secondary] = key(i);
    entries[offsets[primary + 1]++] = {secondary, i};
  }
  offsets.pop_back();
  for (Index b = 0; b < buckets; ++b) {
    std::sort(entries.begin() + offsets[b], entries.begin() + offsets[b + 1],
              [](const BucketEntry& x, const BucketEntry& y) {
                return std::pair(x.key, x.item) < std::pair(y.key, y.item);
              });
  }
  return entries;
}

}  // namespace

EdgeGroups::EdgeGroups(const Soup& soup) {
  std::vector<Index> buckets;
  const auto ends = [&](Index h) -> std::pair<Index, Index> {
    return std::minmax({soup.from(h), soup.to(h)});
  };
  const std::vector<BucketEntry> entries =
      bucket_sort(soup.vertex_count(), soup.halfedge_count(), ends, buckets);
  halfedges_.reserve(entries.size());
  offsets_.reserve(entries.size() / 2 + 1);
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    for (Index i = buckets[v]; i < buckets[v + 1]; ++i) {
      if (i == buckets[v] || entries[i].key != entries[i - 1].key) {
        offsets_.push_back(static_cast<Index>(halfedges_.size()));
      }
      halfedges_.push_back(entries[i].item);
    }
  }
  offsets_.push_back(static_cast<Index>(halfedges_.size()));
}

void remove_faces(Soup& soup, const std::vector<std::uint8_t>& remove) {
  Index kept = 0;
  for (Index f = 0; f < soup.face_count(); ++f) {
    if (remove[f] != 0) continue;
    soup.faces[kept] = soup.faces[f];
    if (!soup.texture.empty()) soup.texture[kept] = soup.texture[f];
    soup.source_face[kept++] = soup.source_face[f];
  }
  if (!soup.texture.empty()) soup.texture.resize(kept);
  soup.faces.resize(kept);
  soup.source_face.resize(kept);
}

double face_area(const Soup& soup, Index face) {
  const auto& [a, b, c] = soup.faces[face];
  const Vec3& p = soup.positions[a];
  return 0.5 * (soup.positions[b] - p).cross(soup.positions[c] - p).norm();
}

double total_area(const Soup& soup) {
  double area = 0;
  for (Index f = 0; f < soup.face_count(); ++f) area += face_area(soup, f);
  return area;
}

bool is_narrow(double area, const Eigen::AlignedBox3d& box, double diagonal) {
  constexpr double kNarrow = 1e-5;  // what rounding leaves of a union is written with 5 digits
  return area <= kNarrow * diagonal * box.diagonal().norm();
}

void drop_degenerate_faces(Soup& soup, Repairs& repairs) {
  std::vector<std::uint8_t> remove(soup.faces.size(), 0);
  std::int64_t count = 0;
  for (Index f = 0; f < soup.face_count(); ++f) {
    const auto& [a, b, c] = soup.faces[f];
    remove[f] = a == b || b == c || c == a ? 1 : 0;
    count += remove[f];
  }
  if (count > 0) remove_faces(soup, remove);
  repairs.degenerate_faces += count;
}

namespace {

/// The number of faces with the same corners as each, at the first of them; 0 at the others.
std::vector<Index> count_copies(const Soup& soup) {
  const auto sorted = [&](Index f) {
    Triangle face = soup.faces[f];
    std::sort(face.begin(), face.end());
    return face;
  };
  std::vector<Index> buckets;
  const std::vector<BucketEntry> entries = bucket_sort(
      soup.vertex_count(), soup.face_count(),
      [&](Index f) {
        const Triangle face = sorted(f);
        return std::pair(face[0], face[1]);
      },
      buckets);
  std::vector<Index> copies(soup.faces.size(), 1);
  std::vector<std::pair<Index, Index>> fan;  // third corner and face, of those with two the same
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    for (Index i = buckets[v]; i < buckets[v + 1];) {
      const Index key = entries[i].key;
      fan.clear();
      for (; i < buckets[v + 1] && entries[i].key == key; ++i) {
        fan.emplace_back(sorted(entries[i].item)[2], entries[i].item);
      }
      std::sort(fan.begin(), fan.end());
      for (std::size_t first = 0, j = 1; j < fan.size(); ++j) {
        if (fan[j].first != fan[first].first) {
          first = j;
        } else {
          ++copies[fan[first].second];
          copies[fan[j].second] = 0;
        }
      }
    }
  }
  return copies;
}

/// Patches of doubled faces, connected over edges. Flags and measures stand at a patch's face
/// `patches.find(f)`.
struct DoubledPatches {
  DoubledPatches(const Soup& soup, const EdgeGroups& groups,
                 const std::vector<std::uint8_t>& is_doubled)
      : sets(soup.face_count()), size(soup.faces.size(), 0), area(soup.faces.size(), 0) {
    for (Index g = 0; g < groups.size(); ++g) {
      Index first = kNone;
      for (const Index h : groups[g]) {
        if (is_doubled[h / 3] == 0) continue;
        if (first != kNone) sets.unite(first, h / 3);
        first = h / 3;
      }
    }
    box.resize(soup.faces.size());
    for (Index f = 0; f < soup.face_count(); ++f) {
      const Index patch = sets.find(f);
      ++size[patch];
      area[patch] += face_area(soup, f);
      for (const Index v : soup.faces[f]) box[patch].extend(soup.positions[v]);
    }
  }

  DisjointSets sets;
  std::vector<Index> size;
  std::vector<double> area;
  std::vector<Eigen::AlignedBox3d> box;
};

enum class Inner : std::uint8_t { none, wall, sliver };

/// Finds patches of doubled faces without which solids stay closed. \return [F]
std::vector<Inner> find_inner_faces(const Soup& soup, const std::vector<std::uint8_t>& is_doubled,
                                    double diagonal) {
  const EdgeGroups groups(soup);
  DoubledPatches patches(soup, groups, is_doubled);
  std::vector<std::uint8_t> meets_solids(soup.faces.size(), 0);
  std::vector<std::uint8_t> has_rim(soup.faces.size(), 0);
  std::vector<std::uint8_t> meets_sheets(soup.faces.size(), 0);
  for (Index g = 0; g < groups.size(); ++g) {
    const auto is_inner = [&](Index h) { return is_doubled[h / 3] != 0; };
    const auto inner = std::find_if(groups[g].begin(), groups[g].end(), is_inner);
    if (inner == groups[g].end()) continue;
    const auto count = std::count_if(groups[g].begin(), groups[g].end(), is_inner);
    const auto others = static_cast<std::ptrdiff_t>(groups[g].size()) - count;
    const Index patch = patches.sets.find(*inner / 3);
    if (others == 2) meets_solids[patch] = 1;
    if (others == 0 && count == 1 && patches.size[patch] > 1) has_rim[patch] = 1;
    if (others != 0 && others != 2) meets_sheets[patch] = 1;
  }
  std::vector<Inner> result(soup.faces.size(), Inner::none);
  for (Index f = 0; f < soup.face_count(); ++f) {
    const Index patch = patches.sets.find(f);
    if (is_doubled[f] == 0 || meets_solids[patch] == 0 || meets_sheets[patch] != 0) continue;
    // A rim is that of a sheet, or of what a union has left folded within its own rounding.
    if (has_rim[patch] == 0) result[f] = Inner::wall;
    if (has_rim[patch] != 0 && is_narrow(patches.area[patch], patches.box[patch], diagonal)) {
      result[f] = Inner::sliver;
    }
  }
  return result;
}

}  // namespace

void drop_duplicate_faces(Soup& soup, double diagonal, Repairs& repairs) {
  const std::vector<Index> copies = count_copies(soup);
  std::vector<std::uint8_t> is_copy(soup.faces.size(), 0);
  std::vector<std::uint8_t> is_doubled;
  for (Index f = 0; f < soup.face_count(); ++f) {
    is_copy[f] = copies[f] == 0 ? 1 : 0;
    if (copies[f] == 0) repairs.duplicate_area += face_area(soup, f);
    if (copies[f] != 0) is_doubled.push_back(copies[f] % 2 == 0 ? 1 : 0);
  }
  const auto dropped = static_cast<std::int64_t>(soup.faces.size() - is_doubled.size());
  if (dropped == 0) return;
  repairs.duplicate_faces += dropped;
  remove_faces(soup, is_copy);
  const std::vector<Inner> inner = find_inner_faces(soup, is_doubled, diagonal);
  repairs.inner_faces += std::count(inner.begin(), inner.end(), Inner::wall);
  repairs.folded_slivers += std::count(inner.begin(), inner.end(), Inner::sliver);
  std::vector<std::uint8_t> remove(inner.size());
  std::transform(inner.begin(), inner.end(), remove.begin(),
                 [](Inner kind) { return kind == Inner::none ? 0 : 1; });
  remove_faces(soup, remove);
}

}  // namespace strake::import
