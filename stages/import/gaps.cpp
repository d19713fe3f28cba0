#include "stages/import/gaps.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "common/core/disjoint_sets.h"

namespace strake::import {
namespace {

/// Share of the diagonal: the width from which on a gap that is open all along is a slit.
constexpr double kSlit = 2e-5;
/// Share of its gap by which a slit opens along the surface. Gaps between patches point anywhere: a
/// tenth of all directions are that close to a given one.
constexpr double kOpenAlong = 0.8;

bool is_open(const Soup& soup, const EdgePair& pair, const Vec3& inward, const Vec3& beyond) {
  const Vec3 across = (beyond - inward).stableNormalized();
  for (int k = 0; k < 2; ++k) {
    const Vec3 gap = soup.positions[pair.second[k]] - soup.positions[pair.first[k]];
    if (gap.dot(across) < kOpenAlong * gap.norm()) return false;
  }
  return true;
}

/// One end of a pair of edges.
struct PairEnd {
  Index low;  ///< vertex
  Index high;
  Index pair;

  [[nodiscard]] bool is_that_of(const PairEnd& other) const {
    return low == other.low && high == other.high;
  }
};

/// Those with the same vertices one after the other.
std::vector<PairEnd> ends_of(const std::vector<EdgePair>& pairs) {
  std::vector<PairEnd> ends;
  ends.reserve(2 * pairs.size());
  for (Index i = 0; i < static_cast<Index>(pairs.size()); ++i) {
    for (int k = 0; k < 2; ++k) {
      const auto [low, high] = std::minmax(pairs[i].first[k], pairs[i].second[k]);
      ends.push_back({low, high, i});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const PairEnd& a, const PairEnd& b) {
    return std::array{a.low, a.high, a.pair} < std::array{b.low, b.high, b.pair};
  });
  return ends;
}

}  // namespace

Vec3 inward(const Soup& soup, Index h) {
  const Vec3& from = soup.positions[soup.from(h)];
  const Vec3 along = (soup.positions[soup.to(h)] - from).stableNormalized();
  const Vec3 way = soup.positions[soup.faces[h / 3][(h % 3 + 2) % 3]] - from;
  return (way - way.dot(along) * along).stableNormalized();
}

double height_over(const Soup& soup, Index h) {
  return 2 * face_area(soup, h / 3) /
         (soup.positions[soup.to(h)] - soup.positions[soup.from(h)]).norm();
}

std::vector<double> shortest_edges(const Soup& soup, const std::vector<Index>& border) {
  std::vector<std::uint8_t> is_border(soup.positions.size(), 0);
  for (const Index h : border) is_border[soup.from(h)] = is_border[soup.to(h)] = 1;
  std::vector<double> shortest(soup.positions.size(), std::numeric_limits<double>::infinity());
  for (Index h = 0; h < soup.halfedge_count(); ++h) {
    const Index a = soup.from(h);
    const Index b = soup.to(h);
    if (is_border[a] == 0 && is_border[b] == 0) continue;
    const double length = (soup.positions[a] - soup.positions[b]).norm();
    shortest[a] = std::min(shortest[a], length);
    shortest[b] = std::min(shortest[b], length);
  }
  return shortest;
}

EdgePair edge_pair(const Soup& soup, const std::array<Index, 2>& first,
                   const std::array<Index, 2>& second) {
  const auto distance = [&](int k) {
    return (soup.positions[first[k]] - soup.positions[second[k]]).norm();
  };
  return {first, second, std::max(distance(0), distance(1))};
}

bool lie_on_top(const Soup& soup, Index h, Index other, double diagonal, EdgePair& pair) {
  const Vec3 into = inward(soup, h);
  const Vec3 beyond = inward(soup, other);
  pair.is_open = is_open(soup, pair, into, beyond);
  return pair.gap > kRounding * diagonal && into.dot(beyond) > kOnTop;
}

std::vector<Index> find_chains(const std::vector<EdgePair>& pairs) {
  const std::vector<PairEnd> ends = ends_of(pairs);
  DisjointSets chains(static_cast<Index>(pairs.size()));
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (ends[i].is_that_of(ends[i - 1])) chains.unite(ends[i - 1].pair, ends[i].pair);
  }
  std::vector<Index> chain(pairs.size());
  for (Index i = 0; i < static_cast<Index>(pairs.size()); ++i) chain[i] = chains.find(i);
  return chain;
}

std::vector<std::uint8_t> find_slits(const Soup& soup, const std::vector<EdgePair>& pairs,
                                     const std::vector<Index>& chain, double diagonal) {
  // At the first pair of each chain.
  std::vector<double> width(pairs.size(), 0);
  std::vector<std::uint8_t> is_open(pairs.size(), 1);
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    width[chain[i]] = std::max(width[chain[i]], pairs[i].gap);
    if (!pairs[i].is_open) is_open[chain[i]] = 0;
  }
  const std::vector<PairEnd> ends = ends_of(pairs);
  for (std::size_t i = 1; i < ends.size(); ++i) {
    if (!ends[i].is_that_of(ends[i - 1])) continue;
    const double gap = (soup.positions[ends[i].low] - soup.positions[ends[i].high]).norm();
    if (gap <= kRounding * diagonal) is_open[chain[ends[i].pair]] = 0;
  }
  std::vector<std::uint8_t> is_slit(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    is_slit[i] = is_open[chain[i]] != 0 && width[chain[i]] > kSlit * diagonal ? 1 : 0;
  }
  return is_slit;
}

}  // namespace strake::import
