#include "stages/mesh/strip_count.h"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace strake {
namespace {

constexpr int kMostStripRounds = 4;
/// Longer strips are left: finding that a way does not meet itself takes the square of its length.
constexpr std::size_t kLongestStrip = 400;
constexpr double kImpossible = std::numeric_limits<double>::infinity();
/// Most that a strip may cost by its shape, for each of its rungs. One of the wanted width costs
/// 0.3 to split and 0.6 to take out.
constexpr double kMostPerRung = 1;
/// Largest error of a rung that counts, in mean ones. A mean one is worth as much as a price of 1.
constexpr double kMostError = 4;

Index count_vertices(const PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  std::vector<char> seen(graph.node_count(), 0);
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (g.is_alive(d)) seen[g.from(d)] = 1;
  }
  return static_cast<Index>(std::count(seen.begin(), seen.end(), 1));
}

/// Of the lines of all edges: how far they are from the straight way.
double mean_square_bend(const PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  double sum = 0;
  Index count = 0;
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d)) continue;
    const double bend = graph.bend(d).distance;
    sum += bend * bend;
    ++count;
  }
  return std::max(sum / count, std::numeric_limits<double>::min());
}

/// Every strip once: each edge is a rung of one at most.
std::vector<Strip> find_strips(const PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  std::vector<char> seen(g.dart_count() / 2, 0);
  std::vector<Strip> strips;
  const auto follow = [&](Index dart) {
    // A way that comes to no strip does not from its other edges, either.
    if (seen[DartGraph::edge_of(dart)] != 0) return;
    std::optional<Strip> strip = follow_strip(graph, dart, kLongestStrip, &seen);
    if (strip) strips.push_back(std::move(*strip));
  };
  graph.for_each_cell([&](Index /*d*/, const DartLoop& cell) {
    if (cell.size() != 3 && cell.size() != 5) return;
    for (const Index out : cell) follow(out);
  });
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (g.is_alive(d) && graph.is_outer(d)) follow(d);
  }
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (g.is_alive(d)) follow(d);
  }
  return strips;
}

/// A strip and what it costs, for each of its rungs.
struct Offer {
  Strip strip;
  double cost;
};

class StripCount {
 public:
  StripCount(PolygonGraph& graph, const EdgeLength& wanted, double odd_price)
      : graph_(graph),
        wanted_(wanted),
        odd_price_(odd_price),
        mean_square_bend_(mean_square_bend(graph)) {}

  StripCounts run(Index vertices) {
    for (int round = 0; round < kMostStripRounds; ++round) {
      const Index missing = vertices - count_vertices(graph_);
      if (!make(offers(missing < 0), missing)) break;
    }
    return counts_;
  }

 private:
  /// What becoming a quad is worth to an odd face. A triangle that is split only counts as one,
  /// with a straight corner.
  [[nodiscard]] double end_bonus(Index dart, bool taken_out) const {
    return !taken_out && graph_.cell(dart).size() == 3 ? -odd_price_ : odd_price_;
  }
  /// Of all rungs: squared distances of lines from their straight edges, in mean ones.
  [[nodiscard]] double errors(const Strip& strip) const {
    double sum = 0;
    for (const Index rung : strip.rungs) {
      const double bend = graph_.bend(rung).distance;
      sum += std::min(kMostError, bend * bend / mean_square_bend_);
    }
    return sum;
  }

  [[nodiscard]] double cost(const Strip& strip, bool taken_out) const {
    const auto rungs = static_cast<double>(strip.rungs.size());
    double bonus = 0;
    if (!strip.is_closed && !strip.starts_outside)
      bonus += end_bonus(strip.rungs.front(), taken_out);
    if (!strip.is_closed && !strip.ends_outside) {
      bonus += end_bonus(DartGraph::opposite(strip.rungs.back()), taken_out);
    }
    const double price =
        taken_out ? collapse_price(graph_, strip, wanted_) : split_price(graph_, strip, wanted_);
    if (price - bonus > kMostPerRung * rungs) return kImpossible;
    const double gain = taken_out ? collapse_gain(graph_, strip) : split_gain(graph_, strip);
    const double shape = (price - bonus - gain) / rungs;
    if (!(shape <= kMostPerRung)) return kImpossible;
    return shape + (taken_out ? 1 : -1) * errors(strip) / rungs;
  }

  /// What can be done, the cheapest first.
  [[nodiscard]] std::vector<Offer> offers(bool taken_out) const {
    std::vector<Offer> found;
    for (Strip& strip : find_strips(graph_)) {
      const double price = cost(strip, taken_out);
      if (price < kImpossible) found.push_back({std::move(strip), price});
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Offer& a, const Offer& b) { return a.cost < b.cost; });
    return found;
  }

  /// \param missing  vertices; negative where there are too many \return whether any was made
  bool make(const std::vector<Offer>& offers, Index missing) {
    ClaimedNodes claimed(graph_);
    bool any = false;
    Index left = std::abs(missing);
    for (const Offer& offer : offers) {
      const auto rungs = static_cast<Index>(offer.strip.rungs.size());
      // Nearer to the wanted number than before.
      if (rungs / 2 >= left) continue;
      if (!claim_strip(graph_, offer.strip, missing < 0, claimed)) continue;
      if (missing < 0) {
        collapse_strip(graph_, offer.strip);
        ++counts_.collapsed;
      } else {
        split_strip(graph_, offer.strip);
        ++counts_.split;
      }
      any = true;
      left = std::abs(left - rungs);
    }
    return any;
  }

  PolygonGraph& graph_;
  const EdgeLength& wanted_;
  double odd_price_;
  double mean_square_bend_;
  StripCounts counts_;
};

}  // namespace

StripCounts meet_vertex_count(PolygonGraph& graph, const EdgeLength& wanted, double odd_price,
                              Index vertices) {
  return StripCount(graph, wanted, odd_price).run(vertices);
}

}  // namespace strake
