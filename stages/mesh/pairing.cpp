#include "stages/mesh/pairing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <iterator>
#include <limits>

#include "stages/mesh/cell_change.h"
#include "stages/mesh/claimed_nodes.h"
#include "stages/mesh/patch.h"

namespace strake {
namespace {

constexpr int kMostPairingRounds = 12;
constexpr std::size_t kLongestToPair = 24;
/// Quads between two odd faces that are divided anew together with them.
constexpr std::size_t kMostBetween = 2;
constexpr double kLeastGain = 0.05;
/// Shapes hardly gain more than two badly shaped odd faces cost.
constexpr double kMostShapeGain = 2;
/// Weight of the squared deviation of a degree from four, beside shape penalties of about 1.
constexpr double kDegreePrice = 0.1;

enum class ChangeKind : std::uint8_t { divide_patch, split_strip, collapse_strip };

/// A change that can be made, and what it changes: a patch or a strip.
struct Change {
  double gain;
  ChangeKind kind;
  Patch patch;
  Division division;
  Strip strip;
};

class Pairing {
 public:
  Pairing(PolygonGraph& graph, const EdgeLength& wanted, double price, const EdgeHeights* heights)
      : graph_(graph),
        wanted_(wanted),
        price_(price),
        heights_(heights),
        claimed_(ClaimedNodes::all(graph)) {}

  PairingCounts run() {
    for (int round = 0; round < kMostPairingRounds; ++round) {
      if (!make(changes())) break;
    }
    return counts_;
  }

 private:
  [[nodiscard]] std::size_t sides(Index dart) const {
    std::size_t count = 1;
    for (Index d = graph_.graph().next(dart); d != dart; d = graph_.graph().next(d)) ++count;
    return count;
  }
  /// Everything worth doing, the best first.
  [[nodiscard]] std::vector<Change> changes() const {
    std::vector<Index> odd_cells;  // a dart of each
    graph_.for_each_cell([&](Index d, const DartLoop& cell) {
      if (cell.size() == 3 || cell.size() == 5) odd_cells.push_back(d);
    });
    std::vector<std::vector<Change>> of_cell(odd_cells.size());
    tbb::parallel_for(std::size_t{0}, odd_cells.size(), [&](std::size_t i) {
      for (const Index out : graph_.cell(odd_cells[i])) add_strips(out, of_cell[i]);
      std::vector<Index> way = {odd_cells[i]};
      add_patches(way, of_cell[i]);
    });
    std::vector<Change> found;
    for (std::vector<Change>& some : of_cell) std::ranges::move(some, std::back_inserter(found));
    std::stable_sort(found.begin(), found.end(),
                     [](const Change& a, const Change& b) { return a.gain > b.gain; });
    return found;
  }

  void add_strips(Index out, std::vector<Change>& found) const {
    const std::optional<Strip> strip = follow_strip(graph_, out, kLongestToPair);
    if (!strip) return;
    // Both ways along a strip are found; boundaries are reached from one end only.
    const double bonus = price_ * (strip->ends_outside ? 1 : 2);
    const auto add = [&](ChangeKind kind, double price, const auto& shape_gain) {
      if (price > bonus + kMostShapeGain) return;
      const double gain = bonus - price + shape_gain(graph_, *strip);
      if (gain > kLeastGain) found.push_back({gain, kind, {}, {}, *strip});
    };
    add(ChangeKind::split_strip, split_price(graph_, *strip, wanted_), split_gain);
    add(ChangeKind::collapse_strip, collapse_price(graph_, *strip, wanted_), collapse_gain);
  }

  /// Patches that start with an odd face, go on over quads and end at another odd face.
  void add_patches(std::vector<Index>& way, std::vector<Change>& found) const {
    for (const Index out : graph_.cell(way.back())) {
      const Index across = DartGraph::opposite(out);
      if (graph_.is_barrier(out) || graph_.is_hole(across)) continue;
      const std::size_t n = sides(across);
      way.push_back(across);
      if (n == 3 || n == 5) {
        add_patch(way, found);
      } else if (n == 4 && way.size() <= kMostBetween + 1) {
        add_patches(way, found);
      }
      way.pop_back();
    }
  }

  void add_patch(const std::vector<Index>& cells, std::vector<Change>& found) const {
    // The same cells are found from both ends.
    if (graph_.name_of_cell(cells.back()) < graph_.name_of_cell(cells.front())) return;
    std::optional<Patch> patch = join_cells(graph_, cells);
    if (!patch || !is_changed(*patch)) return;
    const auto penalty = [&](Index dart, Index degree) {
      if (graph_.rank(graph_.graph().from(dart)) != NodeRank::line) return 0.0;
      return kDegreePrice * (degree - 4) * (degree - 4);
    };
    std::optional<Division> division =
        best_division(graph_, *patch, penalty, std::numeric_limits<double>::infinity(), heights_);
    if (!division) return;
    const double gain = division->shape_gain + division->degree_gain + 2 * price_;
    if (!(gain > kLeastGain)) return;
    found.push_back({gain, ChangeKind::divide_patch, std::move(*patch), std::move(*division), {}});
  }

  /// Whether the last round has changed anything there; otherwise it is not worth doing yet.
  [[nodiscard]] bool is_changed(const Patch& patch) const {
    return std::ranges::any_of(patch.outline,
                               [&](Index d) { return claimed_.has(graph_.graph().from(d)); });
  }

  /// Makes the changes that do not touch what an earlier one has changed. \return whether any
  bool make(const std::vector<Change>& changes) {
    claimed_ = ClaimedNodes(graph_);
    bool any = false;
    for (const Change& change : changes) {
      if (!claim(change)) continue;
      apply(change);
      any = true;
    }
    return any;
  }

  [[nodiscard]] bool claim(const Change& change) {
    return change.strip.rungs.empty()
               ? claimed_.claim(change.patch.outline)
               : claim_strip(graph_, change.strip, change.kind == ChangeKind::collapse_strip,
                             claimed_);
  }

  void apply(const Change& change) {
    switch (change.kind) {
      case ChangeKind::divide_patch:
        divide(graph_, change.patch, change.division);
        ++counts_.divided_patches;
        break;
      case ChangeKind::split_strip:
        split_strip(graph_, change.strip);
        ++counts_.split_strips;
        break;
      case ChangeKind::collapse_strip:
        collapse_strip(graph_, change.strip);
        ++counts_.collapsed_strips;
        break;
    }
  }

  PolygonGraph& graph_;
  const EdgeLength& wanted_;
  double price_;
  const EdgeHeights* heights_;  ///< not owned
  ClaimedNodes claimed_;        ///< in this round, or the last one until its changes are made
  PairingCounts counts_;
};

}  // namespace

PairingCounts pair_odd_faces(PolygonGraph& graph, const EdgeLength& wanted, double price,
                             const EdgeHeights* heights) {
  if (!(price > 0)) return {};
  return Pairing(graph, wanted, price, heights).run();
}

}  // namespace strake
