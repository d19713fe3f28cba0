#include "stages/import/soup.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

void remove_faces(Soup& soup, const std::vector<std::uint8_t>& remove) {
  Index kept = 0;
  for (Index f = 0; f < soup.face_count(); ++f) {
    if (remove[f] != 0) continue;
    soup.faces[kept] = soup.faces[f];
    soup.source_face[kept++] = soup.source_face[f];
  }
  soup.faces.resize(kept);
  soup.source_face.resize(kept);
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

void drop_duplicate_faces(Soup& soup, Repairs& repairs) {
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
  std::vector<std::uint8_t> remove(soup.faces.size(), 0);
  std::int64_t count = 0;
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    for (Index i = buckets[v]; i < buckets[v + 1]; ++i) {
      const Index third = sorted(entries[i].item)[2];
      for (Index j = i - 1; j >= buckets[v] && entries[j].key == entries[i].key; --j) {
        if (sorted(entries[j].item)[2] != third) continue;
        remove[entries[i].item] = 1;
        ++count;
        break;
      }
    }
  }
  if (count > 0) remove_faces(soup, remove);
  repairs.duplicate_faces += count;
}

}  // namespace strake::import
