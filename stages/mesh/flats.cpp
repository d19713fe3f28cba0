#include "stages/mesh/flats.h"

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "common/geometry/plane/triangulate_outlines.h"
#include "stages/mesh/flat_parts.h"

namespace strake {
namespace {

/// Times that all features which still cross are split.
constexpr int kMostSplits = 20;
/// Times that a gap is filled or takes in what is around it.
constexpr int kMostFillings = 4;

/// Edges by their even darts.
using EdgeSet = std::set<Index>;

Index even(Index dart) { return dart & ~1; }

/// Splits the features of a part that cross each other. \return how many
Index split_features(PolygonGraph& graph, const FlatParts& parts, Index part) {
  EdgeSet crossing;
  for (const auto& [a, b] : parts.outline_crossings(part)) {
    if (!graph.is_barrier(a) || !graph.is_barrier(b)) continue;
    for (const Index d : {a, b}) {
      if (graph.bend(d).distance > 0) crossing.insert(even(d));
    }
  }
  for (const Index d : crossing) graph.split(d, graph.bend(d).share);
  return static_cast<Index>(crossing.size());
}

/// Takes edges out of one flat part and fills the gaps.
class Redrawing {
 public:
  Redrawing(PolygonGraph& graph, FlatParts& parts, Index part)
      : graph_(graph), parts_(parts), part_(part) {}

  /// \return gaps filled
  Index run() {
    Index filled = 0;
    find_bad_edges();
    for (int round = 0; round < kMostFillings && !removed_.empty(); ++round) {
      remove_loose_ends();
      EdgeSet next;  // what cannot be filled takes in the cells around it
      for (const std::vector<Index>& gap : gaps()) {
        remove_within(gap);
        if (fill(gap)) {
          ++filled;
          continue;
        }
        for (const Index cell : gap) add_sides(cell, next);
      }
      if (next == removed_) break;
      removed_ = std::move(next);
    }
    return filled;
  }

 private:
  [[nodiscard]] bool is_removed(Index dart) const { return removed_.contains(even(dart)); }

  void find_bad_edges() {
    std::vector<Index> bad = parts_.turned(part_);
    if (bad.empty() && parts_.outline_crossings(part_).empty()) return;
    const FlatParts::Crossings crossings = parts_.crossings(part_);
    if (parts_.is_tangle(part_, crossings)) return;
    for (const auto& [a, b] : crossings) bad.insert(bad.end(), {a, b});
    std::ranges::sort(bad);
    bad.erase(std::unique(bad.begin(), bad.end()), bad.end());
    for (const Index d : bad) {
      if (parts_.is_inside(part_, d)) removed_.insert(even(d));
    }
  }

  void add_sides(Index cell, EdgeSet& edges) const {
    for (const Index d : graph_.cell(cell)) {
      if (parts_.is_inside(part_, d)) edges.insert(even(d));
    }
  }

  void remove_loose_ends() {
    const DartGraph& g = graph_.graph();
    std::vector<Index> open;
    for (const Index d : removed_) open.insert(open.end(), {d, DartGraph::opposite(d)});
    while (!open.empty()) {
      const Index start = open.back();
      open.pop_back();
      Index last = kNone;  // that still leaves the node
      int count = 0;
      Index d = start;
      do {
        if (!is_removed(d)) {
          last = d;
          ++count;
        }
        d = g.rotate_ccw(d);
      } while (d != start);
      if (count != 1 || !parts_.is_inside(part_, last)) continue;
      removed_.insert(even(last));
      open.push_back(DartGraph::opposite(last));
    }
  }

  /// The cells that become one where edges are removed.
  [[nodiscard]] std::vector<std::vector<Index>> gaps() const {
    std::set<Index> seen;
    std::vector<std::vector<Index>> found;
    for (const Index first : removed_) {
      if (!seen.insert(parts_.cell_of(first)).second) continue;
      std::vector<Index> gap = {parts_.cell_of(first)};
      for (std::size_t at = 0; at < gap.size(); ++at) {
        for (const Index d : graph_.cell(gap[at])) {
          if (!is_removed(d)) continue;
          const Index other = parts_.cell_of(DartGraph::opposite(d));
          if (seen.insert(other).second) gap.push_back(other);
        }
      }
      found.push_back(std::move(gap));
    }
    return found;
  }

  /// Removes edges that have a gap on both sides: they enclose nothing.
  void remove_within(const std::vector<Index>& gap) {
    const std::set<Index> cells(gap.begin(), gap.end());
    for (const Index cell : gap) {
      for (const Index d : graph_.cell(cell)) {
        if (cells.contains(parts_.cell_of(DartGraph::opposite(d))) && parts_.is_inside(part_, d)) {
          removed_.insert(even(d));
        }
      }
    }
  }

  /// The darts that follow each other along the border of a gap, the gap on their left.
  [[nodiscard]] std::vector<Index> outline_from(Index first) const {
    const DartGraph& g = graph_.graph();
    std::vector<Index> outline;
    Index d = first;
    do {
      outline.push_back(d);
      d = g.next(d);
      while (is_removed(d)) d = g.next(DartGraph::opposite(d));
    } while (d != first);
    return outline;
  }

  /// The outlines of a gap: around it, and around what stays inside of it.
  [[nodiscard]] std::vector<std::vector<Index>> outlines(const std::vector<Index>& gap) const {
    std::vector<std::vector<Index>> found;
    std::set<Index> seen;
    for (const Index cell : gap) {
      for (const Index d : graph_.cell(cell)) {
        if (is_removed(d) || seen.contains(d)) continue;
        found.push_back(outline_from(d));
        seen.insert(found.back().begin(), found.back().end());
      }
    }
    return found;
  }

  /// Triangles of nodes; none where the outlines cross.
  [[nodiscard]] std::vector<std::array<Index, 3>> triangles_within(
      const std::vector<std::vector<Index>>& outlines) const {
    std::vector<Index> nodes;
    for (const std::vector<Index>& outline : outlines) {
      for (const Index d : outline) nodes.push_back(graph_.graph().from(d));
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    std::vector<Vec2> points;
    for (const Index node : nodes) points.push_back(parts_.place(part_, node));
    std::vector<std::vector<Index>> rings;
    for (const std::vector<Index>& outline : outlines) {
      std::vector<Index> ring;
      for (const Index d : outline) {
        const auto at = std::ranges::lower_bound(nodes, graph_.graph().from(d));
        ring.push_back(static_cast<Index>(at - nodes.begin()));
      }
      rings.push_back(std::move(ring));
    }
    auto triangles = triangulate_outlines(points, rings);
    for (auto& triangle : triangles) {
      for (Index& corner : triangle) corner = nodes[corner];
    }
    return triangles;
  }

  bool fill(const std::vector<Index>& gap) {
    const std::vector<std::vector<Index>> around = outlines(gap);
    const std::vector<std::array<Index, 3>> triangles = triangles_within(around);
    if (triangles.empty()) return false;
    EdgeSet inside;
    for (const Index cell : gap) {
      for (const Index d : graph_.cell(cell)) {
        if (is_removed(d)) inside.insert(even(d));
      }
    }
    const std::vector<Index> made =
        graph_.refill(around, std::vector<Index>(inside.begin(), inside.end()), triangles);
    if (made.empty()) return false;
    parts_.replace(part_, gap, made);
    return true;
  }

  PolygonGraph& graph_;
  FlatParts& parts_;
  Index part_;
  EdgeSet removed_;
};

}  // namespace

Index split_crossing_features(PolygonGraph& graph) {
  FlatParts parts(graph);
  Index count = 0;
  for (Index part = 0; part < parts.size(); ++part) {
    for (int round = 0; round < kMostSplits; ++round) {
      const Index split = split_features(graph, parts, part);
      if (split == 0) break;
      count += split;
      parts.update(part);
    }
  }
  return count;
}

Index redraw_flats(PolygonGraph& graph) {
  FlatParts parts(graph);
  Index filled = 0;
  for (Index part = 0; part < parts.size(); ++part) {
    filled += Redrawing(graph, parts, part).run();
  }
  return filled;
}

}  // namespace strake
