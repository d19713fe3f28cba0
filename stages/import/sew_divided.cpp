#include "stages/import/sew_divided.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <tuple>
#include <utility>

#include "common/core/disjoint_sets.h"
#include "stages/import/border_contacts.h"
#include "stages/import/gaps.h"
#include "stages/import/put_into_edges.h"
#include "stages/import/sheet_sides.h"
#include "stages/import/weld.h"

namespace strake::import {
namespace {

/// A gap over the part of an edge beside it, at most: what is left of an edge with a fifth of it
/// less at both ends may have a gap of that fifth.
constexpr double kGapOverPart = 1.0 / 3;

/// A border edge, or what lies between two vertices to be put into it.
struct Part {
  std::array<Index, 2> places;    ///< of its ends, ascending
  std::array<Index, 2> ends;      ///< vertices in these
  std::array<bool, 2> is_curved;  ///< at an end, which a vertex is to be put to
  Index halfedge;
  bool is_forward;  ///< from the first end to the second is the way of the half-edge
  bool is_whole;
};

double length(const Soup& soup, const Part& part) {
  return (soup.positions[part.ends[1]] - soup.positions[part.ends[0]]).norm();
}

/// Parts by their places. Appends the vertices to be put into edges to the soup, in the order of
/// the stops.
std::vector<Part> find_parts(Soup& soup, const std::vector<Index>& border,
                             const BorderContacts& contacts) {
  std::vector<Part> parts;
  parts.reserve(border.size() + contacts.stops.size());
  struct End {
    Index vertex;
    Index place;
    bool is_curved;
  };
  auto stop = contacts.stops.begin();
  for (const Index h : border) {
    const auto end_of_edge = [&](Index v) { return End{v, contacts.place[v], false}; };
    End last = end_of_edge(soup.from(h));
    bool is_whole = true;
    const auto add_to = [&](const End& end) {
      const bool is_forward = last.place < end.place;
      const End& low = is_forward ? last : end;
      const End& high = is_forward ? end : last;
      if (low.place != high.place) {
        parts.push_back({{low.place, high.place},
                         {low.vertex, high.vertex},
                         {low.is_curved, high.is_curved},
                         h,
                         is_forward,
                         is_whole});
      }
      last = end;
    };
    for (; stop != contacts.stops.end() && stop->halfedge == h; ++stop) {
      is_whole = false;
      const Vec3& from = soup.positions[soup.from(h)];
      const Vec3 at = from + stop->share * (soup.positions[soup.to(h)] - from);
      soup.positions.push_back(at);
      soup.source_vertex.push_back(kNone);
      add_to({soup.vertex_count() - 1, contacts.place[stop->vertex], stop->is_curved});
    }
    add_to(end_of_edge(soup.to(h)));
  }
  std::sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) {
    return std::tie(a.places, a.halfedge, a.ends) < std::tie(b.places, b.halfedge, b.ends);
  });
  return parts;
}

/// What a pair is made of.
struct PairParts {
  std::array<Index, 2> places;    ///< of its ends
  std::array<bool, 2> is_curved;  ///< at an end: on one side
  bool has_part;                  ///< that is no whole edge
  bool is_of_two;                 ///< no more sheets meet there
  SheetSides::Joint faces;
};

/// Parts that are to be joined, in pairs.
class PartPairs {
 public:
  PartPairs(const Soup& soup, std::span<const Part> parts, double diagonal)
      : soup_(soup), diagonal_(diagonal) {
    for (std::size_t i = 0; i < parts.size();) {
      std::size_t end = i;
      while (end < parts.size() && parts[end].places == parts[i].places) ++end;
      pair_up(parts.subspan(i, end - i));
      i = end;
    }
  }

  /// Those of chains with a part that is no whole edge, that are no slits, leave the surface two
  /// sides, and do not end where borders are as far apart as they bulge. Other chains are left to
  /// `sew_gaps`.
  [[nodiscard]] std::vector<EdgePair> joined() const {
    const std::vector<Index> chain = find_chains(pairs_);
    std::vector<std::uint8_t> is_left = find_slits(soup_, pairs_, chain, diagonal_);
    std::vector<std::uint8_t> is_divided(pairs_.size(), 0);  // at the first pair of each chain
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (parts_[i].has_part) is_divided[chain[i]] = 1;
    }
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (is_divided[chain[i]] == 0) is_left[i] = 1;
    }
    leave_one_sided_chains(chain, is_left);
    leave_loose_chains(chain, is_left);
    std::vector<EdgePair> result;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (is_left[i] == 0) result.push_back(pairs_[i]);
    }
    return result;
  }

 private:
  /// Of parts between the same two places.
  void pair_up(std::span<const Part> parts) {
    constexpr std::size_t kManySheets = 16;
    if (parts.size() == 2) return add(parts[0], parts[1]);
    const auto is_beside = [&](const Part& part) {
      return gap_of(parts[0], part) <= kCoincident * diagonal_;
    };
    if (std::all_of(parts.begin(), parts.end(), is_beside)) {
      for (std::size_t i = 1; i < parts.size(); ++i) add(parts[i - 1], parts[i], false);
    } else if (parts.size() <= kManySheets) {
      for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::size_t j = nearest_by_far(parts, i);
        if (j > i && j < parts.size() && nearest_by_far(parts, j) == i) add(parts[i], parts[j]);
      }
    }
  }

  /// The number of parts where there is none.
  [[nodiscard]] std::size_t nearest_by_far(std::span<const Part> parts, std::size_t i) const {
    std::size_t nearest = parts.size();
    double gap = std::numeric_limits<double>::infinity();
    double next_gap = gap;
    for (std::size_t j = 0; j < parts.size(); ++j) {
      if (j == i) continue;
      const double other = gap_of(parts[i], parts[j]);
      if (other < gap) nearest = j;
      next_gap = std::min(next_gap, std::max(gap, other));
      gap = std::min(gap, other);
    }
    return next_gap >= kClear * gap ? nearest : parts.size();
  }

  [[nodiscard]] double gap_of(const Part& a, const Part& b) const {
    return edge_pair(soup_, a.ends, b.ends).gap;
  }

  void add(const Part& a, const Part& b, bool is_of_two = true) {
    EdgePair pair = edge_pair(soup_, a.ends, b.ends);
    const PairParts parts{a.places,
                          {a.is_curved[0] || b.is_curved[0], a.is_curved[1] || b.is_curved[1]},
                          !a.is_whole || !b.is_whole,
                          is_of_two,
                          {a.halfedge / 3, b.halfedge / 3, a.is_forward != b.is_forward}};
    const double most =
        std::min(kGapOverPart * std::min(length(soup_, a), length(soup_, b)), kWidest * diagonal_);
    for (int k = 0; k < 2; ++k) {
      const double gap = (soup_.positions[a.ends[k]] - soup_.positions[b.ends[k]]).norm();
      if (gap > most && !parts.is_curved[k]) return;
    }
    if (a.halfedge == b.halfedge) return;
    if (is_flat(a) && is_flat(b)) return;  // of pieces without area nothing is sewn
    if (lie_on_top(soup_, a.halfedge, b.halfedge, diagonal_, pair)) return;
    pairs_.push_back(pair);
    parts_.push_back(parts);
  }

  /// Leaves chains that would leave the surface one side only, those of wide gaps first.
  void leave_one_sided_chains(const std::vector<Index>& chain,
                              std::vector<std::uint8_t>& is_left) const {
    std::vector<double> width(pairs_.size(), 0);  // at the first pair of each chain
    std::vector<Index> order;
    for (Index i = 0; i < static_cast<Index>(pairs_.size()); ++i) {
      width[chain[i]] = std::max(width[chain[i]], pairs_[i].gap);
      if (is_left[i] == 0) order.push_back(i);
    }
    if (order.empty()) return;
    std::sort(order.begin(), order.end(), [&](Index a, Index b) {
      return std::tuple(width[chain[a]], chain[a], a) < std::tuple(width[chain[b]], chain[b], b);
    });
    SheetSides sides(soup_);
    for (std::size_t i = 0; i < order.size();) {
      std::size_t end = i;
      std::vector<SheetSides::Joint> joints;
      for (; end < order.size() && chain[order[end]] == chain[order[i]]; ++end) {
        const PairParts& parts = parts_[order[end]];
        if (parts.is_of_two) joints.push_back(parts.faces);
      }
      const bool is_joined = sides.join(joints);
      for (; i < end; ++i) is_left[order[i]] = is_joined ? 0 : 1;
    }
  }

  /// Leaves chains that end at a place where they are as far apart as borders bulge, with those
  /// that go on from such places: two curves that are one do not part.
  void leave_loose_chains(const std::vector<Index>& chain,
                          std::vector<std::uint8_t>& is_left) const {
    struct End {
      Index place;
      Index chain;
      bool is_curved;
    };
    std::vector<End> ends;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (is_left[i] != 0) continue;
      for (int k = 0; k < 2; ++k) {
        ends.push_back({parts_[i].places[k], chain[i], parts_[i].is_curved[k]});
      }
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
      return std::tie(a.place, a.chain) < std::tie(b.place, b.chain);
    });
    DisjointSets going_on(static_cast<Index>(pairs_.size()));  // chains
    std::vector<Index> loose;
    for (std::size_t i = 0; i < ends.size();) {
      std::size_t last = i;
      bool is_curved = false;
      for (; last < ends.size() && ends[last].place == ends[i].place; ++last) {
        is_curved = is_curved || ends[last].is_curved;
      }
      if (is_curved && last == i + 1) loose.push_back(ends[i].chain);
      for (std::size_t j = i + 1; is_curved && j < last; ++j) {
        going_on.unite(ends[i].chain, ends[j].chain);
      }
      i = last;
    }
    std::vector<std::uint8_t> is_loose(pairs_.size(), 0);
    for (const Index i : loose) is_loose[going_on.find(i)] = 1;
    for (std::size_t i = 0; i < pairs_.size(); ++i) {
      if (is_loose[going_on.find(chain[i])] != 0) is_left[i] = 1;
    }
  }

  [[nodiscard]] bool is_flat(const Part& part) const {
    return height_over(soup_, part.halfedge) <= kCoincident * diagonal_;
  }

  const Soup& soup_;
  double diagonal_;
  std::vector<EdgePair> pairs_;
  std::vector<PairParts> parts_;  ///< [pairs]
};

/// Of the stops those whose vertices, from `first` on, are ends of pairs; with these vertices.
std::vector<Stop> used_stops(const BorderContacts& contacts, const std::vector<EdgePair>& pairs,
                             Index first) {
  std::vector<std::uint8_t> is_used(contacts.stops.size(), 0);
  for (const EdgePair& pair : pairs) {
    for (const Index v : {pair.first[0], pair.first[1], pair.second[0], pair.second[1]}) {
      if (v >= first) is_used[v - first] = 1;
    }
  }
  std::vector<Stop> used;
  for (std::size_t i = 0; i < is_used.size(); ++i) {
    if (is_used[i] == 0) continue;
    used.push_back(contacts.stops[i]);
    used.back().vertex = first + static_cast<Index>(i);
  }
  return used;
}

/// Edges with what is put into them, as vertices of the input.
std::vector<DividedEdge> divided_edges(const Soup& soup, const std::vector<Stop>& stops,
                                       DisjointSets& joined) {
  std::vector<DividedEdge> edges;
  Index last = kNone;
  for (const Stop& stop : stops) {
    if (stop.halfedge != last) {
      edges.push_back({soup.source_vertex[soup.from(stop.halfedge)],
                       soup.source_vertex[soup.to(stop.halfedge)],
                       {}});
    }
    edges.back().inside.push_back(soup.source_vertex[joined.find(stop.vertex)]);
    last = stop.halfedge;
  }
  return edges;
}

/// \return whether anything was sewn
bool sew_once(Soup& soup, std::vector<Index>& border, double diagonal, Repairs& repairs) {
  if (border.empty()) return false;
  const BorderContacts contacts = find_border_contacts(soup, border, diagonal);
  if (contacts.stops.empty()) return false;
  const Index first = soup.vertex_count();
  const std::vector<Part> parts = find_parts(soup, border, contacts);
  const std::vector<EdgePair> pairs = PartPairs(soup, parts, diagonal).joined();
  if (pairs.empty()) {
    soup.positions.resize(first);
    soup.source_vertex.resize(first);
    return false;
  }
  DisjointSets joined(soup.vertex_count());
  for (const EdgePair& pair : pairs) {
    for (int k = 0; k < 2; ++k) {
      const Index a = pair.first[k];
      const Index b = pair.second[k];
      joined.unite(a, b);
      double& widest = std::max(a, b) < first ? repairs.widest_gap : repairs.widest_divided_gap;
      widest = std::max(widest, (soup.positions[a] - soup.positions[b]).norm());
    }
  }
  const std::vector<Stop> stops = used_stops(contacts, pairs, first);
  soup.divided.push_back(divided_edges(soup, stops, joined));
  put_into_edges(soup, stops);
  for (Index v = 0; v < first; ++v) repairs.sewn_vertices += joined.find(v) == v ? 0 : 1;
  repairs.sewn_into_edges += static_cast<std::int64_t>(stops.size());
  rename_vertices(soup, joined, repairs.farthest_moved);
  border = find_borders(soup);
  return true;
}

}  // namespace

std::vector<Index> sew_divided_borders(Soup& soup, std::vector<Index> border, double diagonal,
                                       Repairs& repairs) {
  // What vertices are nearest to is sewn first; then they are one, and what comes next is nearest.
  constexpr int kMostRounds = 3;
  for (int round = 0; round < kMostRounds; ++round) {
    if (!sew_once(soup, border, diagonal, repairs)) break;
  }
  return border;
}

}  // namespace strake::import
