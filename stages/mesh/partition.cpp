#include "stages/mesh/partition.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/angles.h"
#include "stages/mesh/cell_shape.h"
#include "stages/mesh/cell_view.h"
#include "stages/mesh/off_surface.h"

namespace strake {
namespace {

/// Reflex corners up to this angle are moved into line; larger ones divide their face.
constexpr double kMovableAngle = 200 * kDegree;
/// How far inside the straight line a moved corner comes to lie, as a share of its edges.
constexpr double kBulge = 1e-3;
constexpr int kMoveRounds = 8;
constexpr std::size_t kLargestScored = 24;
constexpr std::size_t kLargestSearched = 1000;

class Partitioner {
 public:
  Partitioner(PolygonGraph& graph, Index max_sides, const EdgeHeights* heights)
      : graph_(graph), max_sides_(max_sides), heights_(heights) {}

  PartitionCounts run() {
    separate_pinched();
    divide_all([&](const DartLoop& cell) {
      return static_cast<Index>(cell.size()) > max_sides_ || has_reflex(cell, kMovableAngle);
    });
    move_into_line();
    divide_all([&](const DartLoop& cell) { return has_reflex(cell, 0); });
    return counts_;
  }

 private:
  bool has_reflex(const DartLoop& cell, double above) const {
    const Polygon p = corner_positions(graph_, cell);
    const Vec3 n = vector_area(p).normalized();
    for (std::size_t i = 0; i < p.size(); ++i) {
      if (is_reflex(p, i, n) && interior_angle(p, i, n) > above) return true;
    }
    return false;
  }

  /// One dart of every cell.
  std::vector<Index> cells() const {
    std::vector<Index> first;
    graph_.for_each_cell([&](Index d, const DartLoop&) { first.push_back(d); });
    return first;
  }

  template <class Needs>
  void divide_all(const Needs& needs) {
    std::vector<Index> stack = cells();
    std::reverse(stack.begin(), stack.end());
    while (!stack.empty()) {
      const Index d = stack.back();
      stack.pop_back();
      const DartLoop cell = graph_.cell(d);
      if (cell.size() < 4 || !needs(cell)) continue;
      const Index diagonal = best_diagonal(cell);
      if (diagonal == kNone) {
        fan_out(cell);
        continue;
      }
      stack.push_back(diagonal);
      stack.push_back(DartGraph::opposite(diagonal));
    }
  }

  /// Adds the diagonal with the best score; kNone where none is allowed. A reflex corner, where
  /// there is one, takes part in it.
  Index best_diagonal(const DartLoop& cell) {
    const DartGraph& g = graph_.graph();
    const Polygon p = corner_positions(graph_, cell);
    const CellView view(graph_, cell, p);
    std::vector<char> reflex(p.size(), 0);
    bool any_reflex = false;
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Vec3& n = view.normal(i);
      reflex[i] = is_reflex(p, i, n) && (interior_angle(p, i, n) > kMovableAngle || p.size() <= 5);
      any_reflex = any_reflex || reflex[i] != 0;
    }
    const OffSurface off(graph_, cell, heights_);
    if (p.size() > kLargestScored) return shortest_balanced_diagonal(cell, p, view, off);
    for (const bool relaxed : {false, true}) {
      double best = std::numeric_limits<double>::infinity();
      std::pair<std::size_t, std::size_t> choice{0, 0};
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (std::size_t j = i + 2; j < p.size(); ++j) {
          if (i == 0 && j + 1 == p.size()) continue;
          if (!relaxed && any_reflex && reflex[i] == 0 && reflex[j] == 0) continue;
          if (g.from(cell[i]) == g.from(cell[j])) continue;
          if (!relaxed && !view.contains(i, j)) continue;
          if (graph_.find_edge(cell[i], g.from(cell[j])) != kNone) continue;
          Polygon one(p.begin() + static_cast<std::ptrdiff_t>(i),
                      p.begin() + static_cast<std::ptrdiff_t>(j) + 1);
          Polygon two(p.begin() + static_cast<std::ptrdiff_t>(j), p.end());
          two.insert(two.end(), p.begin(), p.begin() + static_cast<std::ptrdiff_t>(i) + 1);
          double score = shape_penalty(one, view.normal_of(i, j)) +
                         shape_penalty(two, view.normal_of(j, i)) + off.price(p[i], p[j]);
          if (relaxed && !(score < std::numeric_limits<double>::infinity())) {
            // Any division is better than none where a face has too many sides.
            score = 1e6 + (p[i] - p[j]).norm();
          }
          if (!view.contains(i, j)) score += 1e3;
          if (score < best && (is_lid(cell, p, i, j) || is_lid(cell, p, j, i))) {
            if (!relaxed) continue;
            score += 2e3;  // more than what seems to run outside of a cell that goes around
          }
          if (score < best) {
            best = score;
            choice = {i, j};
          }
        }
      }
      if (best < std::numeric_limits<double>::infinity()) {
        ++counts_.diagonals;
        return graph_.connect(cell[choice.first], cell[choice.second]);
      }
      if (!relaxed && static_cast<Index>(p.size()) <= max_sides_ && !any_reflex) return kNone;
    }
    return kNone;
  }

  /// Whether the diagonal cuts off a part along features or boundaries alone, from corner i to j,
  /// that looks against the surface under it: of the wall of a pipe, between places of its rim, a
  /// second end upside down.
  [[nodiscard]] bool is_lid(const DartLoop& cell, const Polygon& p, std::size_t i,
                            std::size_t j) const {
    if (heights_ == nullptr) return false;
    Polygon part;
    for (std::size_t k = i; k != j; k = (k + 1) % p.size()) {
      if (!graph_.is_barrier(cell[k])) return false;
      part.push_back(p[k]);
    }
    part.push_back(p[j]);
    return vector_area(part).dot(heights_->normal_below(p[i], p[j])) < 0;
  }

  /// Divides a cell that no diagonal divides, from a new node in its middle.
  void fan_out(const DartLoop& cell) {
    Vec3 middle = Vec3::Zero();
    for (const Vec3& v : corner_positions(graph_, cell))
      middle += v / static_cast<double>(cell.size());
    const Index spoke = graph_.connect(cell[0], cell[2]);
    const Index half = graph_.split(spoke, 0.5);
    const Index node = graph_.graph().from(half);
    graph_.move(node, middle);
    counts_.diagonals += 2;
    // The node's corner in the cell before a dart is the dart that leaves the node there.
    for (std::size_t i = 1; i < cell.size(); ++i) {
      if (i == 2) continue;
      Index corner = graph_.graph().next(cell[i]);
      while (graph_.graph().from(corner) != node) corner = graph_.graph().next(corner);
      graph_.connect(corner, cell[i]);
      ++counts_.diagonals;
    }
    ++counts_.centred_faces;
  }

  /// For cells with too many sides to score all diagonals: the shortest that leaves at least a
  /// quarter of the sides on each side, and in folded cells lies near the surface. Of very many
  /// corners only every few ones are looked at: ways are as many as their squares, and of a needle
  /// none lies inside.
  Index shortest_balanced_diagonal(const DartLoop& cell, const Polygon& p, const CellView& view,
                                   const OffSurface& off) {
    const DartGraph& g = graph_.graph();
    const std::size_t n = p.size();
    const std::size_t step = 1 + n / kLargestSearched;
    for (const bool inside : {true, false}) {
      double best = std::numeric_limits<double>::infinity();
      std::pair<std::size_t, std::size_t> choice{0, 0};
      for (std::size_t i = 0; i < n; i += step) {
        for (std::size_t j = i + n / 4; j < n && j - i <= n - n / 4; j += step) {
          double length = (p[i] - p[j]).squaredNorm();
          if (length >= best || g.from(cell[i]) == g.from(cell[j])) continue;
          if (inside && !view.contains(i, j)) continue;
          if (graph_.find_edge(cell[i], g.from(cell[j])) != kNone) continue;
          if (view.is_folded()) length *= 1 + off.price(p[i], p[j]);
          if (length >= best) continue;
          best = length;
          choice = {i, j};
        }
      }
      if (choice.first == choice.second) continue;
      ++counts_.diagonals;
      return graph_.connect(cell[choice.first], cell[choice.second]);
    }
    return kNone;
  }

  /// Cells that touch themselves in a node: a diagonal separates the two visits, between new nodes
  /// where the old ones leave no way.
  void separate_pinched() {
    const DartGraph& g = graph_.graph();
    std::vector<Index> stack = cells();
    std::size_t budget = 20 * stack.size() + 1000;
    while (!stack.empty() && budget-- > 0) {
      const Index d = stack.back();
      stack.pop_back();
      DartLoop cell = graph_.cell(d);
      const auto [i, j] = repeated(cell);
      if (i == j) continue;
      const auto arc_dart = [&](std::size_t from, std::size_t to) {
        // A node strictly inside the arc, away from both visits if possible.
        const std::size_t n = cell.size();
        const std::size_t steps = (to + n - from) % n;
        return steps >= 2 ? cell[(from + steps / 2) % n] : kNone;
      };
      Index a = arc_dart(i, j);
      Index b = arc_dart(j, i);
      if (a == kNone) a = graph_.split(cell[i], 0.5);
      if (b == kNone) b = graph_.split(cell[j], 0.5);
      // New nodes have no other edges; the two sides of one edge take a few to come apart.
      for (bool turn = true; g.from(a) == g.from(b) || graph_.find_edge(a, g.from(b)) != kNone;
           turn = !turn) {
        Index& end = turn ? a : b;
        end = graph_.split(end, 0.5);
      }
      const Index diagonal = graph_.connect(a, b);
      ++counts_.diagonals;
      stack.push_back(diagonal);
      stack.push_back(DartGraph::opposite(diagonal));
    }
  }

  /// Two positions of a cell at the same node; equal where there are none.
  std::pair<std::size_t, std::size_t> repeated(const DartLoop& cell) const {
    std::vector<std::pair<Index, std::size_t>> nodes;
    for (std::size_t i = 0; i < cell.size(); ++i)
      nodes.emplace_back(graph_.graph().from(cell[i]), i);
    std::sort(nodes.begin(), nodes.end());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      if (nodes[i].first == nodes[i - 1].first) return {nodes[i - 1].second, nodes[i].second};
    }
    return {0, 0};
  }

  /// Moves slightly reflex corners of lines onto the straight line between their neighbours.
  void move_into_line() {
    const std::vector<Index> firsts = cells();
    for (int round = 0; round < kMoveRounds; ++round) {
      Index moved = 0;
      for (const Index d : firsts) moved += straighten(graph_.cell(d));
      counts_.moved_nodes += moved;
      if (moved == 0) break;
    }
  }

  Index straighten(const DartLoop& cell) {
    if (cell.size() < 4) return 0;
    Index moved = 0;
    Polygon p = corner_positions(graph_, cell);
    for (std::size_t i = 0; i < p.size(); ++i) {
      const Index node = graph_.graph().from(cell[i]);
      const Vec3 n = vector_area(p).normalized();
      if (graph_.rank(node) != NodeRank::line || !is_reflex(p, i, n)) continue;
      if (interior_angle(p, i, n) > kMovableAngle) continue;
      const Vec3& before = p[(i + p.size() - 1) % p.size()];
      const Vec3& after = p[(i + 1) % p.size()];
      const Vec3 along = after - before;
      const double length2 = along.squaredNorm();
      if (!(length2 > 0)) continue;
      const double t = std::clamp((p[i] - before).dot(along) / length2, 0.1, 0.9);
      const Vec3 on_line = before + t * along;
      const Vec3 outwards = along.cross(n).normalized();
      // Only within the polygon's plane: off it the corner keeps its height above the chord.
      const Vec3 offset = on_line - p[i];
      const Vec3 step = outwards * (offset.dot(outwards) + kBulge * along.norm());
      p[i] += step;
      graph_.move(node, p[i]);
      ++moved;
    }
    return moved;
  }

  PolygonGraph& graph_;
  Index max_sides_;
  const EdgeHeights* heights_;  ///< not owned
  PartitionCounts counts_;
};

}  // namespace

PartitionCounts partition(PolygonGraph& graph, Index max_sides, const EdgeHeights* heights) {
  return Partitioner(graph, max_sides, heights).run();
}

}  // namespace strake
