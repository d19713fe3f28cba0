#include "stages/import/fill_holes.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "stages/import/hole_patch.h"
#include "stages/import/sheets.h"

namespace strake::import {
namespace {

/// Share of the size of its component that a hole is smaller than.
constexpr double kLargestShare = 0.5;

/// An outline, in the sense of the faces that fill it.
struct Outline {
  std::vector<Index> vertices;
  std::vector<Index> beyond;  ///< half-edge from the next vertex to each
};

Eigen::AlignedBox3d box_of(const Soup& soup, const Outline& outline) {
  Eigen::AlignedBox3d box;
  for (const Index v : outline.vertices) box.extend(soup.positions[v]);
  return box;
}

/// An outline that meets itself in vertices of which there are copies, one a fan, is several that
/// share the first of these.
/// \param kept  [V] what each vertex becomes
void part_where_fans_meet(const Soup& soup, const Outline& whole, std::vector<Outline>& outlines,
                          std::vector<Index>& kept) {
  std::map<Index, std::size_t> at;  // in the way so far, by the vertex of the file
  Outline way;
  const auto cut_off = [&](std::size_t begin) {
    Outline& part = outlines.emplace_back();
    part.vertices.assign(way.vertices.begin() + std::ptrdiff_t(begin), way.vertices.end());
    part.beyond.assign(way.beyond.begin() + std::ptrdiff_t(begin), way.beyond.end());
    for (const Index v : part.vertices) at.erase(soup.source_vertex[v]);
    way.vertices.resize(begin);
    way.beyond.resize(begin);
  };
  for (std::size_t i = 0; i < whole.vertices.size(); ++i) {
    Index v = whole.vertices[i];
    const Index source = soup.source_vertex[v];
    const auto met = source == kNone ? at.end() : at.find(source);
    if (met != at.end() && soup.positions[way.vertices[met->second]] == soup.positions[v]) {
      const Index first = way.vertices[met->second];
      kept[v] = first;
      cut_off(met->second);
      v = first;
    }
    if (source != kNone) at[source] = way.vertices.size();
    way.vertices.push_back(v);
    way.beyond.push_back(whole.beyond[i]);
  }
  cut_off(0);
}

std::vector<Outline> find_outlines(const Soup& soup) {
  const EdgeGroups edges(soup);
  std::vector<Index> into(soup.positions.size(), kNone);  // the border that ends at a vertex
  for (Index e = 0; e < edges.size(); ++e) {
    if (edges[e].size() == 1) into[soup.to(edges[e][0])] = edges[e][0];
  }
  std::vector<Outline> outlines;
  for (Index start = 0; start < soup.vertex_count(); ++start) {
    if (into[start] == kNone) continue;
    Outline& outline = outlines.emplace_back();
    for (Index v = start; into[v] != kNone; v = soup.from(outline.beyond.back())) {
      outline.vertices.push_back(v);
      outline.beyond.push_back(std::exchange(into[v], kNone));
    }
  }
  return outlines;
}

/// The outlines of all openings. Copies of a vertex, one a fan, become one where an outline meets
/// itself in them. \param are_fans_joined  becomes whether there are such
std::vector<Outline> part_outlines(Soup& soup, bool& are_fans_joined) {
  std::vector<Index> kept(soup.positions.size());
  std::iota(kept.begin(), kept.end(), 0);
  std::vector<Outline> outlines;
  for (const Outline& whole : find_outlines(soup)) {
    part_where_fans_meet(soup, whole, outlines, kept);
  }
  for (Triangle& face : soup.faces) {
    for (Index& v : face) {
      are_fans_joined = are_fans_joined || kept[v] != v;
      v = kept[v];
    }
  }
  return outlines;
}

/// Leaves those that are holes: neither too wide, nor where their component ends.
void keep_holes(const Soup& soup, double most_across, std::vector<Outline>& outlines) {
  DisjointSets components(soup.vertex_count());
  for (const auto& [a, b, c] : soup.faces) {
    components.unite(a, b);
    components.unite(b, c);
  }
  std::vector<Eigen::AlignedBox3d> boxes(soup.positions.size());
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    boxes[components.find(v)].extend(soup.positions[v]);
  }
  std::erase_if(outlines, [&](const Outline& outline) {
    const double size = boxes[components.find(outline.vertices[0])].diagonal().norm();
    const double across = box_of(soup, outline).diagonal().norm();
    return across > std::min(most_across, kLargestShare * size);
  });
}

/// What vertices of outlines are joined to.
class Neighbours {
 public:
  Neighbours(const Soup& soup, const std::vector<Outline>& outlines) {
    std::vector<std::uint8_t> is_asked(soup.positions.size(), 0);
    for (const Outline& outline : outlines) {
      for (const Index v : outline.vertices) is_asked[v] = 1;
    }
    for (Index h = 0; h < soup.halfedge_count(); ++h) {
      const Index a = soup.from(h);
      const Index b = soup.to(h);
      if (is_asked[a] != 0) pairs_.emplace_back(a, b);
      if (is_asked[b] != 0) pairs_.emplace_back(b, a);
    }
    std::sort(pairs_.begin(), pairs_.end());
    pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  }

  [[nodiscard]] bool are_joined(Index a, Index b) const {
    return std::binary_search(pairs_.begin(), pairs_.end(), std::pair(a, b));
  }
  template <class Visit>
  void for_each(Index v, Visit visit) const {
    for (auto at = std::lower_bound(pairs_.begin(), pairs_.end(), std::pair(v, Index{0}));
         at != pairs_.end() && at->first == v; ++at) {
      visit(at->second);
    }
  }

 private:
  std::vector<std::pair<Index, Index>> pairs_;
};

HolePatch patch_of(const Soup& soup, const Neighbours& neighbours, const Outline& outline) {
  const std::size_t n = outline.vertices.size();
  HoleOutline hole;
  for (std::size_t i = 0; i < n; ++i) {
    const Index v = outline.vertices[i];
    hole.places.push_back(soup.positions[v]);
    const auto& [a, b, c] = soup.faces[outline.beyond[i] / 3];
    const Vec3& p = soup.positions[a];
    hole.beyond.push_back((soup.positions[b] - p).cross(soup.positions[c] - p).normalized());
    auto& around = hole.around.emplace_back();
    neighbours.for_each(v, [&](Index u) {
      const bool is_next = u == outline.vertices[(i + 1) % n];
      const bool is_last = u == outline.vertices[(i + n - 1) % n];
      if (!is_next && !is_last) around.push_back(soup.positions[u]);
    });
  }
  return patch_of(hole, [&](std::size_t i, std::size_t j) {
    return !neighbours.are_joined(outline.vertices[i], outline.vertices[j]);
  });
}

/// The side of an outline whose middle is nearest.
std::size_t nearest_side(const Soup& soup, const Outline& outline, const Vec3& place) {
  const std::size_t n = outline.vertices.size();
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 middle =
        0.5 * (soup.positions[outline.vertices[i]] + soup.positions[outline.vertices[(i + 1) % n]]);
    const double distance = (middle - place).squaredNorm();
    if (distance < least) {
      least = distance;
      nearest = i;
    }
  }
  return nearest;
}

/// Texture coordinates of the vertices of a patch: those of the outline, and between these.
std::vector<TexturePoint> texture_of(const Soup& soup, const Outline& outline,
                                     const HolePatch& patch) {
  std::vector<TexturePoint> result;
  for (const Index h : outline.beyond) result.push_back(soup.texture[h / 3][(h % 3 + 1) % 3]);
  for (const Vec3& place : patch.inside) {
    TexturePoint sum{};
    double weights = 0;
    for (std::size_t i = 0; i < outline.vertices.size(); ++i) {
      const double weight =
          1 / std::max((soup.positions[outline.vertices[i]] - place).squaredNorm(), 1e-300);
      for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * result[i][k];
      weights += weight;
    }
    for (double& value : sum) value /= weights;
    result.push_back(sum);
  }
  return result;
}

void append(const Outline& outline, const HolePatch& patch, Soup& soup) {
  std::vector<Index> vertices = outline.vertices;
  const std::vector<TexturePoint> texture =
      soup.texture.empty() ? std::vector<TexturePoint>() : texture_of(soup, outline, patch);
  for (const Vec3& place : patch.inside) {
    vertices.push_back(soup.vertex_count());
    soup.positions.push_back(place);
    soup.source_vertex.push_back(kNone);
  }
  for (const auto& [a, b, c] : patch.faces) {
    const Triangle face = {vertices[a], vertices[b], vertices[c]};
    const Vec3 middle =
        (soup.positions[face[0]] + soup.positions[face[1]] + soup.positions[face[2]]) / 3;
    const Index beside = outline.beyond[nearest_side(soup, outline, middle)] / 3;
    soup.faces.push_back(face);
    soup.source_face.push_back(Index{soup.source_face[beside]});
    if (!texture.empty()) soup.texture.push_back({texture[a], texture[b], texture[c]});
  }
}

}  // namespace

Index count_holes(const Soup& soup, double most_across) {
  std::vector<Outline> holes = find_outlines(soup);
  keep_holes(soup, most_across, holes);
  return static_cast<Index>(holes.size());
}

FilledHoles fill_holes(Soup& soup, double most_across) {
  bool are_fans_joined = false;
  std::vector<Outline> holes = part_outlines(soup, are_fans_joined);
  keep_holes(soup, most_across, holes);
  const Neighbours neighbours(soup, holes);
  std::vector<HolePatch> patches(holes.size());
  tbb::parallel_for(std::size_t{0}, holes.size(),
                    [&](std::size_t i) { patches[i] = patch_of(soup, neighbours, holes[i]); });
  FilledHoles result;
  for (std::size_t i = 0; i < holes.size(); ++i) {
    if (patches[i].faces.empty()) {
      ++result.left;
      continue;
    }
    result.widest = std::max(result.widest, box_of(soup, holes[i]).diagonal().norm());
    ++result.filled;
    append(holes[i], patches[i], soup);
  }
  if (are_fans_joined) {  // where a hole stayed open its fans get their copies back
    Repairs counted_before;
    make_manifold(soup, counted_before);
  }
  return result;
}

}  // namespace strake::import
