#include "stages/import/sew.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "common/geometry/face_crossings/box_tree.h"
#include "stages/import/gaps.h"
#include "stages/import/weld.h"

namespace strake::import {
namespace {

/// Share of the diagonal: how far apart borders are told to be near.
constexpr double kToldNear = 5e-4;
/// Share of the distance of two borders by which it leads into the faces of both across a strip.
constexpr double kAcross = 0.25;

Vec3 middle_of(const Soup& soup, Index h) {
  return (soup.positions[soup.from(h)] + soup.positions[soup.to(h)]) / 2;
}

EdgePair paired(const Soup& soup, Index h, Index other) {
  const std::array<Index, 2> ends = {soup.from(h), soup.to(h)};
  const EdgePair opposite = edge_pair(soup, ends, {soup.to(other), soup.from(other)});
  const EdgePair alike = edge_pair(soup, ends, {soup.from(other), soup.to(other)});
  return alike.gap < opposite.gap ? alike : opposite;
}

/// The nearest other border edge, and how far away the next one is.
struct Partner {
  Index at = kNone;  ///< in the list of border edges
  double gap = std::numeric_limits<double>::infinity();
  double next_gap = std::numeric_limits<double>::infinity();
};

class PartnerSearch {
 public:
  PartnerSearch(const Soup& soup, const std::vector<Index>& border, double diagonal)
      : soup_(soup),
        border_(border),
        widest_(kWidest * diagonal),
        shortest_(shortest_edges(soup, border)),
        tree_(middles(soup, border)) {}

  [[nodiscard]] std::vector<Partner> partners() const {
    std::vector<Partner> found(border_.size());
    tbb::parallel_for(std::size_t{0}, border_.size(),
                      [&](std::size_t i) { found[i] = partner_of(static_cast<Index>(i)); });
    return found;
  }
  /// The widest gap that may be closed at the ends of an edge.
  [[nodiscard]] double most_at(Index h) const {
    return std::min(widest_,
                    kGapOverEdge * std::min(shortest_[soup_.from(h)], shortest_[soup_.to(h)]));
  }

 private:
  static BoxTree middles(const Soup& soup, const std::vector<Index>& border) {
    std::vector<BoxTree::Box> boxes;
    boxes.reserve(border.size());
    for (const Index h : border) boxes.emplace_back(middle_of(soup, h));
    return BoxTree(boxes);
  }

  [[nodiscard]] Partner partner_of(Index i) const {
    Partner partner;
    const double reach = kClear * most_at(border_[i]);
    if (!(reach > 0)) return partner;
    const Vec3 middle = middle_of(soup_, border_[i]);
    const BoxTree::Box box(middle.array() - reach, middle.array() + reach);
    tree_.visit_touching(box, [&](Index j) {
      if (j == i) return;
      const double gap = paired(soup_, border_[i], border_[j]).gap;
      if (gap < partner.gap) {
        partner = {j, gap, partner.gap};
      } else {
        partner.next_gap = std::min(partner.next_gap, gap);
      }
    });
    return partner;
  }

  const Soup& soup_;
  const std::vector<Index>& border_;
  double widest_;
  std::vector<double> shortest_;
  BoxTree tree_;
};

/// The ends of border edges, by vertex.
class BorderEnds {
 public:
  BorderEnds(const Soup& soup, const std::vector<Index>& border) : soup_(soup) {
    for (const Index h : border) {
      at_.emplace_back(soup.from(h), soup.to(h));
      at_.emplace_back(soup.to(h), soup.from(h));
    }
    std::sort(at_.begin(), at_.end());
  }

  /// Whether two border edges are a notch of the outline: they part at the vertex that they share,
  /// and the border turns off where the shorter one ends. Along a crack it goes on beside the
  /// other.
  [[nodiscard]] bool is_notch(Index g, Index h) const {
    const Index shared = touches(h, soup_.from(g)) ? soup_.from(g) : soup_.to(g);
    if (!touches(h, shared)) return false;
    const Index of_g = soup_.from(g) + soup_.to(g) - shared;
    const Index of_h = soup_.from(h) + soup_.to(h) - shared;
    const bool is_g = way(shared, of_g).squaredNorm() <= way(shared, of_h).squaredNorm();
    return !goes_on(shared, is_g ? of_g : of_h);
  }

 private:
  [[nodiscard]] bool touches(Index h, Index vertex) const {
    return soup_.from(h) == vertex || soup_.to(h) == vertex;
  }
  [[nodiscard]] Vec3 way(Index from, Index to) const {
    return soup_.positions[to] - soup_.positions[from];
  }
  /// Whether a border edge leads straight on where the one from `from` to `at` ends.
  [[nodiscard]] bool goes_on(Index from, Index at) const {
    const Vec3 along = way(from, at).stableNormalized();
    for (auto end = std::lower_bound(at_.begin(), at_.end(), std::pair(at, Index{0}));
         end != at_.end() && end->first == at; ++end) {
      if (along.dot(way(at, end->second).stableNormalized()) > kOnTop) return true;
    }
    return false;
  }

  const Soup& soup_;
  std::vector<std::pair<Index, Index>> at_;  ///< a vertex and the other end of an edge there
};

}  // namespace

std::vector<Index> sew_gaps(Soup& soup, const std::vector<Index>& border, double diagonal,
                            Repairs& repairs) {
  if (border.empty()) return border;
  const PartnerSearch search(soup, border, diagonal);
  const std::vector<Partner> partners = search.partners();
  std::vector<EdgePair> pairs;
  for (Index i = 0; i < static_cast<Index>(border.size()); ++i) {
    const auto& [j, gap, next_gap] = partners[i];
    if (j == kNone || j < i || partners[j].at != i) continue;
    const double most = std::min(search.most_at(border[i]), search.most_at(border[j]));
    if (gap > most || std::min(next_gap, partners[j].next_gap) < kClear * gap) continue;
    EdgePair pair = paired(soup, border[i], border[j]);
    if (!lie_on_top(soup, border[i], border[j], diagonal, pair)) pairs.push_back(pair);
  }
  if (pairs.empty()) return border;

  const std::vector<std::uint8_t> is_slit = find_slits(soup, pairs, find_chains(pairs), diagonal);
  DisjointSets joined(soup.vertex_count());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (is_slit[i] != 0) continue;
    for (int k = 0; k < 2; ++k) joined.unite(pairs[i].first[k], pairs[i].second[k]);
    repairs.widest_gap = std::max(repairs.widest_gap, pairs[i].gap);
  }
  repairs.sewn_vertices = rename_vertices(soup, joined, repairs.farthest_moved);
  return repairs.sewn_vertices > 0 ? without_joined(soup, border) : border;
}

NearBorders find_near_borders(const Soup& soup, const std::vector<Index>& border, double diagonal) {
  const BorderEnds ends(soup, border);
  std::vector<BoxTree::Box> boxes;
  boxes.reserve(border.size());
  for (const Index h : border) {
    BoxTree::Box box(soup.positions[soup.from(h)]);
    boxes.push_back(box.extend(soup.positions[soup.to(h)]));
  }
  const BoxTree tree(boxes);
  std::vector<double> nearest(border.size(), std::numeric_limits<double>::infinity());
  tbb::parallel_for(std::size_t{0}, border.size(), [&](std::size_t i) {
    const Index h = border[i];
    const Vec3 middle = middle_of(soup, h);
    const Vec3 along = soup.positions[soup.to(h)] - soup.positions[soup.from(h)];
    const double reach = std::min(kToldNear * diagonal, along.norm() / 4);
    const Vec3 into = inward(soup, h);
    const BoxTree::Box box(middle.array() - reach, middle.array() + reach);
    tree.visit_touching(box, [&](Index j) {
      if (j == static_cast<Index>(i)) return;
      const Vec3& from = soup.positions[soup.from(border[j])];
      const Vec3 other = soup.positions[soup.to(border[j])] - from;
      const double share = std::clamp((middle - from).dot(other) / other.squaredNorm(), 0.0, 1.0);
      const Vec3 gap = from + share * other - middle;
      if (gap.norm() > reach || gap.norm() >= nearest[i]) return;
      // Beside it, not ahead; not on top of it; not across a strip between the two.
      const bool is_along = std::abs(along.dot(other)) > kOnTop * along.norm() * other.norm();
      const Vec3 beyond = inward(soup, border[j]);
      const double overlap = std::min(gap.dot(into), -gap.dot(beyond));
      const bool is_strip = overlap > kAcross * gap.norm() && gap.norm() > kRounding * diagonal;
      if (!is_along || into.dot(beyond) > kOnTop || is_strip) return;
      if (!ends.is_notch(h, border[j])) nearest[i] = gap.norm();
    });
  });
  NearBorders near;
  for (const double distance : nearest) {
    if (std::isinf(distance)) continue;
    ++near.edges;
    near.widest = std::max(near.widest, distance);
  }
  return near;
}

}  // namespace strake::import
