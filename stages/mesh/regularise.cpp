#include "stages/mesh/regularise.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <vector>

#include "stages/mesh/cell_change.h"
#include "stages/mesh/claimed_nodes.h"
#include "stages/mesh/patch.h"
#include "stages/mesh/simplify.h"

namespace strake {
namespace {

constexpr int kMostRounds = 12;
/// More quads in a row cancel hardly more than these do.
constexpr std::size_t kMostQuads = 3;
constexpr double kLeastQuadGain = 0.05;
/// Faces that are made have at most this shape penalty, unless there was a worse one in their
/// place: that of a rhombus with angles of 46 and 134 degrees.
constexpr double kWorstShape = 0.6;

/// A change that can be made: a patch to be divided, or else a quad to be closed.
struct QuadChange {
  double gain;
  Patch patch;
  Division division;
  Index closed_quad;
};

class Regularising {
 public:
  Regularising(PolygonGraph& graph, double price, const EdgeHeights* heights)
      : graph_(graph), price_(price), heights_(heights) {}

  RegularisingCounts run() {
    active_.assign(graph_.node_count(), 1);
    for (int round = 0; round < kMostRounds; ++round) {
      ClaimedNodes claimed(graph_);
      bool any = false;
      for (const QuadChange& change : changes()) {
        any = (claim(change, claimed) && apply(change)) || any;
      }
      if (!any) break;
      for (Index n = 0; n < graph_.node_count(); ++n) active_[n] = claimed.has(n) ? 1 : 0;
    }
    return counts_;
  }

 private:
  /// Everything worth doing at active nodes, the best first.
  std::vector<QuadChange> changes() {
    find_excess();
    std::vector<Index> quads;  // a dart of each
    graph_.for_each_cell([&](Index d, const DartLoop& cell) {
      if (cell.size() == 4) quads.push_back(d);
    });
    std::vector<std::vector<QuadChange>> of_quad(quads.size());
    tbb::parallel_for(std::size_t{0}, quads.size(),
                      [&](std::size_t i) { add_changes(quads[i], of_quad[i]); });
    std::vector<QuadChange> found;
    for (std::vector<QuadChange>& some : of_quad)
      std::ranges::move(some, std::back_inserter(found));
    std::stable_sort(found.begin(), found.end(),
                     [](const QuadChange& a, const QuadChange& b) { return a.gain > b.gain; });
    return found;
  }

  void add_changes(Index quad, std::vector<QuadChange>& found) const {
    const DartLoop cell = graph_.cell(quad);
    if (any_corner(cell, [&](Index n) { return active_[n] != 0; })) {
      add_closing(cell[0], found);
      add_closing(cell[1], found);
    }
    // An edge that is removed has such an end, which a cell at the end of the row has, too.
    if (any_corner(cell, [&](Index n) { return excess_[n] > 0; })) {
      std::vector<Index> row = {quad};
      add_patches(row, found);
    }
  }

  [[nodiscard]] bool any_corner(const DartLoop& cell, const auto& is_wanted) const {
    return std::any_of(cell.begin(), cell.end(),
                       [&](Index d) { return is_wanted(graph_.graph().from(d)); });
  }

  /// Edges that nodes have too many, or too few with a minus.
  void find_excess() {
    const DartGraph& g = graph_.graph();
    excess_.assign(graph_.node_count(), 0);
    std::vector<char> seen(graph_.node_count(), 0);
    for (Index d = 0; d < g.dart_count(); ++d) {
      if (!g.is_alive(d) || seen[g.from(d)] != 0) continue;
      seen[g.from(d)] = 1;
      const Index degree = graph_.degree(d);
      const Index off = irregularity(graph_, d, degree);
      excess_[g.from(d)] = degree < 4 ? -off : off;
    }
  }

  /// Rows of quads that start with the one in `row`.
  void add_patches(std::vector<Index>& row, std::vector<QuadChange>& found) const {
    for (const Index out : graph_.cell(row.back())) {
      const Index across = DartGraph::opposite(out);
      if (graph_.is_barrier(out) || graph_.is_hole(across) || graph_.cell(across).size() != 4) {
        continue;
      }
      row.push_back(across);
      if (may_gain(row)) add_patch(row, found);
      if (row.size() < kMostQuads) add_patches(row, found);
      row.pop_back();
    }
  }

  /// Whether an edge between the cells could go from a node with too many to one with too few, and
  /// could not have before.
  [[nodiscard]] bool may_gain(const std::vector<Index>& row) const {
    const DartGraph& g = graph_.graph();
    const auto has_too_many = [&](Index dart) {
      return excess_[g.from(dart)] > 0 || excess_[g.to(dart)] > 0;
    };
    if (std::none_of(row.begin() + 1, row.end(), has_too_many)) return false;
    bool is_active = false;
    bool has_too_few = false;
    for (const Index cell : row) {
      Index d = cell;
      do {
        is_active = is_active || active_[g.from(d)] != 0;
        has_too_few = has_too_few || excess_[g.from(d)] < 0;
        d = g.next(d);
      } while (d != cell);
    }
    return is_active && has_too_few;
  }

  void add_patch(const std::vector<Index>& cells, std::vector<QuadChange>& found) const {
    std::optional<Patch> patch = join_cells(graph_, cells);
    if (!patch) return;
    const auto penalty = [&](Index dart, Index degree) {
      return price_ * irregularity(graph_, dart, degree);
    };
    double worst = kWorstShape;
    for (const Index cell : cells) {
      worst = std::max(worst, penalty_now(corner_positions(graph_, graph_.cell(cell))));
    }
    std::optional<Division> division = best_division(graph_, *patch, penalty, worst, heights_);
    if (!division || !(division->degree_gain > 0)) return;
    const double gain = division->shape_gain + division->degree_gain;
    if (gain > kLeastQuadGain)
      found.push_back({gain, std::move(*patch), std::move(*division), kNone});
  }

  /// The corner that is across the quad from the origin of `dart`.
  [[nodiscard]] Index across(Index dart) const {
    return graph_.graph().next(graph_.graph().next(dart));
  }

  [[nodiscard]] bool is_free(Index dart) const {
    return graph_.rank(graph_.graph().from(dart)) == NodeRank::line;
  }

  /// Where from(dart) meets the corner across: in the middle, or at the one on a feature.
  [[nodiscard]] Vec3 meeting_place(Index dart) const {
    const Vec3& a = graph_.position(graph_.graph().from(dart));
    const Vec3& c = graph_.position(graph_.graph().from(across(dart)));
    if (is_free(dart) && is_free(across(dart))) return (a + c) / 2;
    return is_free(dart) ? c : a;
  }

  /// By how much fewer edges are too many or too few when from(dart) is merged with the corner
  /// across; nothing where a node would be left with too few to be one.
  [[nodiscard]] std::optional<Index> regularity_gain(Index dart) const {
    const Index other = across(dart);
    const Index a = graph_.degree(dart);
    const Index c = graph_.degree(other);
    Index gain = irregularity(graph_, dart, a) + irregularity(graph_, other, c);
    const Index kept = is_free(dart) ? other : dart;
    const bool is_bound = graph_.rank(graph_.graph().from(kept)) != NodeRank::line;
    // What counts nothing where it stays counts by what it gets there.
    gain -= is_bound && irregularity(graph_, kept, 5) == 0 ? (is_free(dart) ? a : c) - 2
                                                           : irregularity(graph_, kept, a + c - 2);
    for (const Index side : {graph_.graph().next(dart), graph_.graph().next(other)}) {
      const Index degree = graph_.degree(side);
      if (degree <= (is_free(side) ? 3 : 2)) return std::nullopt;
      gain += irregularity(graph_, side, degree) - irregularity(graph_, side, degree - 1);
    }
    return gain;
  }

  void add_closing(Index dart, std::vector<QuadChange>& found) const {
    const DartGraph& g = graph_.graph();
    if (!is_free(dart) && !is_free(across(dart))) return;
    const std::optional<Index> regularity = regularity_gain(dart);
    if (!regularity || *regularity < 2) return;
    Moves moves;
    moves.add(g.from(dart), meeting_place(dart));
    moves.add(g.from(across(dart)), meeting_place(dart));
    std::vector<Index> cells = cells_around(graph_, {dart, across(dart)});
    std::erase(cells, graph_.name_of_cell(dart));
    const double gain = price_ * *regularity +
                        penalty_now(corner_positions(graph_, graph_.cell(dart))) +
                        gain_of_moves(graph_, cells, moves, kWorstShape);
    if (gain > kLeastQuadGain) found.push_back({gain, {}, {}, dart});
  }

  [[nodiscard]] bool claim(const QuadChange& change, ClaimedNodes& claimed) const {
    if (change.closed_quad == kNone) return claimed.claim(change.patch.outline);
    // Where nothing has touched one corner, the quad is what it was.
    const DartGraph& g = graph_.graph();
    const Index dart = change.closed_quad;
    if (claimed.has(g.from(dart)) || claimed.has(g.from(across(dart)))) return false;
    DartLoop corners;
    for (const Index cell : cells_around(graph_, {dart, across(dart)})) {
      const DartLoop around = graph_.cell(cell);
      corners.insert(corners.end(), around.begin(), around.end());
    }
    return claimed.claim(corners);
  }

  bool apply(const QuadChange& change) {
    if (change.closed_quad == kNone) {
      divide(graph_, change.patch, change.division);
      ++counts_.divided_patches;
      return true;
    }
    if (!close_quad(change.closed_quad)) return false;
    ++counts_.closed_quads;
    return true;
  }

  /// Merges from(dart) with the corner across. \return false where that would change the topology
  bool close_quad(Index dart) {
    const DartGraph& g = graph_.graph();
    const Vec3 place = meeting_place(dart);
    const Index diagonal =
        is_free(dart) ? graph_.connect(dart, across(dart)) : graph_.connect(across(dart), dart);
    if (!keeps_topology(graph_, diagonal)) {
      graph_.remove_edge(diagonal);
      return false;
    }
    const Index left = g.next(diagonal);
    const Index right = g.next(DartGraph::opposite(diagonal));
    const Index kept = g.to(diagonal);
    graph_.contract(diagonal);
    graph_.move(kept, place);
    for (const Index side : {left, right}) remove_bigon(graph_, side);
    return true;
  }

  PolygonGraph& graph_;
  double price_;
  const EdgeHeights* heights_;  ///< not owned
  std::vector<char> active_;    ///< [nodes] where the last round changed something
  std::vector<Index> excess_;   ///< [nodes]
  RegularisingCounts counts_;
};

}  // namespace

Index irregularity(const PolygonGraph& graph, Index dart, Index degree) {
  const NodeRank rank = graph.rank(graph.graph().from(dart));
  if (rank == NodeRank::corner) return 0;
  if (rank == NodeRank::barrier) {
    Index d = dart;
    do {
      if (graph.kind(d) == EdgeKind::boundary) return 0;
      d = graph.graph().rotate_ccw(d);
    } while (d != dart);
  }
  return std::abs(degree - 4);
}

RegularisingCounts regularise(PolygonGraph& graph, double price, const EdgeHeights* heights) {
  if (!(price > 0)) return {};
  return Regularising(graph, price, heights).run();
}

}  // namespace strake
