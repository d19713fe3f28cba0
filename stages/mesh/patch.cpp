#include "stages/mesh/patch.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "common/geometry/angles.h"
#include "common/geometry/quad_division.h"
#include "stages/mesh/cell_shape.h"
#include "stages/mesh/off_surface.h"

namespace strake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Most that a quad between kept nodes turns along its shorter diagonal: of what is left of small
/// components quads across an edge would be a third of the shape.
constexpr double kMostTurn = 50 * kDegree;

/// Whether a quad turns by more than that.
bool is_folded(const Polygon& q) {
  const bool first = (q[2] - q[0]).squaredNorm() <= (q[3] - q[1]).squaredNorm();
  const Vec3& a = q[first ? 0 : 1];
  const Vec3 diagonal = q[first ? 2 : 3] - a;
  const Vec3 right = (q[first ? 1 : 2] - a).cross(diagonal);
  const Vec3 left = diagonal.cross(q[first ? 3 : 0] - a);
  return angle_between(right, left) > kMostTurn;
}

/// Finds the best division of a patch.
class Divider {
 public:
  Divider(const PolygonGraph& graph, const Patch& patch, const DegreePenalty& penalty, double worst,
          const EdgeHeights* heights)
      : graph_(graph),
        patch_(patch),
        penalty_(penalty),
        worst_(worst),
        off_(graph, patch.outline, heights),
        p_(corner_positions(graph, patch.outline)) {
    normal_ = vector_area(p_);
    const std::size_t n = p_.size();
    base_degree_.resize(n);
    for (std::size_t i = 0; i < n; ++i) base_degree_[i] = graph.degree(patch.outline[i]);
    for (const Index d : patch.inner) {
      for (std::size_t i = 0; i < n; ++i) {
        const Index node = node_at(i);
        if (graph.graph().from(d) == node || graph.graph().to(d) == node) --base_degree_[i];
      }
    }
  }

  [[nodiscard]] std::optional<Division> run() const {
    std::optional<QuadDivision> cheapest = cheapest_division(
        p_.size(),
        [this](std::size_t i, std::size_t a, std::size_t b, std::size_t j) {
          return quad(i, a, b, j);
        },
        [this](std::size_t i, std::size_t j) { return diagonal(i, j); });
    if (!cheapest) return std::nullopt;
    Division division;
    division.diagonals = std::move(cheapest->diagonals);
    std::vector<Index> degree = base_degree_;
    for (const auto& [i, j] : division.diagonals) {
      ++degree[i];
      ++degree[j];
    }
    for (std::size_t i = 0; i < p_.size(); ++i) {
      if (degree[i] < 3 && graph_.rank(node_at(i)) == NodeRank::line) return std::nullopt;
      division.degree_gain += penalty_(patch_.outline[i], graph_.degree(patch_.outline[i])) -
                              penalty_(patch_.outline[i], degree[i]);
    }
    division.shape_gain = shapes_now();
    for (const auto& [i, a, b, j] : cheapest->quads) division.shape_gain -= quad(i, a, b, j);
    for (const auto& [i, j] : division.diagonals) division.shape_gain -= off_.price(p_[i], p_[j]);
    return division;
  }

 private:
  [[nodiscard]] Index node_at(std::size_t i) const {
    return graph_.graph().from(patch_.outline[i]);
  }

  [[nodiscard]] double quad(std::size_t i, std::size_t a, std::size_t b, std::size_t j) const {
    const Polygon q = {p_[i], p_[a], p_[b], p_[j]};
    const Vec3 n = vector_area(q);
    const double length = n.norm();
    if (!(length > 0)) return kInfinity;
    for (std::size_t k = 0; k < 4; ++k) {
      if (is_reflex(q, k, n / length)) return kInfinity;
    }
    if (graph_.is_kept(node_at(i)) && is_folded(q)) return kInfinity;
    const double penalty = shape_penalty(q, normal_);
    return penalty <= worst_ ? penalty : kInfinity;
  }

  /// Price of a diagonal for its place and the degrees of its ends; infinite where there is such an
  /// edge.
  [[nodiscard]] double diagonal(std::size_t i, std::size_t j) const {
    if (node_at(i) == node_at(j)) return kInfinity;
    const Index other = graph_.find_edge(patch_.outline[i], node_at(j));
    if (other != kNone && !is_inner(other)) return kInfinity;
    double price = off_.price(p_[i], p_[j]);
    for (const std::size_t end : {i, j}) {
      price += penalty_(patch_.outline[end], base_degree_[end] + 1) -
               penalty_(patch_.outline[end], base_degree_[end]);
    }
    return price;
  }

  [[nodiscard]] bool is_inner(Index dart) const {
    return std::any_of(patch_.inner.begin(), patch_.inner.end(),
                       [&](Index d) { return DartGraph::edge_of(d) == DartGraph::edge_of(dart); });
  }

  /// Penalty of the cells and edges as they are.
  [[nodiscard]] double shapes_now() const {
    double sum = 0;
    std::vector<Index> seen;
    const auto add = [&](Index d) {
      const Index name = graph_.name_of_cell(d);
      if (std::find(seen.begin(), seen.end(), name) != seen.end()) return;
      seen.push_back(name);
      const Polygon cell = corner_positions(graph_, graph_.cell(d));
      sum += std::min(shape_penalty(cell, normal_), kWorstShape);
    };
    for (const Index d : patch_.outline) add(d);
    const DartGraph& g = graph_.graph();
    for (const Index d : patch_.inner) {
      sum += off_.price(graph_.position(g.from(d)), graph_.position(g.to(d)));
    }
    return sum;
  }

  static constexpr double kWorstShape = 10;

  const PolygonGraph& graph_;
  const Patch& patch_;
  const DegreePenalty& penalty_;
  double worst_;
  OffSurface off_;
  Polygon p_;
  Vec3 normal_ = Vec3::Zero();
  std::vector<Index> base_degree_;  ///< [n] without the edges inside
};

}  // namespace

std::optional<Patch> join_cells(const PolygonGraph& graph, const std::vector<Index>& cells) {
  const DartGraph& g = graph.graph();
  DartLoop darts;
  for (const Index d : cells) {
    Index dart = d;
    do {
      darts.push_back(dart);
      dart = g.next(dart);
    } while (dart != d);
  }
  std::sort(darts.begin(), darts.end());
  if (std::adjacent_find(darts.begin(), darts.end()) != darts.end()) return std::nullopt;
  const auto has = [&](Index d) { return std::binary_search(darts.begin(), darts.end(), d); };
  Patch patch;
  Index start = kNone;
  for (const Index d : darts) {
    if (!has(DartGraph::opposite(d))) {
      if (start == kNone) start = d;
    } else if (graph.is_barrier(d)) {
      return std::nullopt;
    } else if (d % 2 == 0) {
      patch.inner.push_back(d);
    }
  }
  // A tree of edges between cells leaves no node inside.
  if (start == kNone || patch.inner.size() + 1 != cells.size()) return std::nullopt;
  DartLoop nodes;
  Index d = start;
  do {
    patch.outline.push_back(d);
    nodes.push_back(g.from(d));
    d = g.next(d);
    while (has(DartGraph::opposite(d))) d = g.next(DartGraph::opposite(d));
  } while (d != start);
  std::sort(nodes.begin(), nodes.end());
  if (std::adjacent_find(nodes.begin(), nodes.end()) != nodes.end()) return std::nullopt;
  if (patch.outline.size() % 2 != 0 || patch.outline.size() < 4) return std::nullopt;
  if (patch.outline.size() + 2 * patch.inner.size() != darts.size()) return std::nullopt;
  return patch;
}

std::optional<Division> best_division(const PolygonGraph& graph, const Patch& patch,
                                      const DegreePenalty& penalty, double worst,
                                      const EdgeHeights* heights) {
  return Divider(graph, patch, penalty, worst, heights).run();
}

void divide(PolygonGraph& graph, const Patch& patch, const Division& division) {
  for (const Index d : patch.inner) graph.remove_edge(d);
  // Each diagonal (i, j) cuts the corners from i to j off the innermost run that holds both; the
  // corners strictly inside a run leave it by their edges of the outline.
  struct Run {
    std::size_t first, last;
    Index closing;  ///< leaves corner `last`
  };
  std::vector<Run> runs = {{0, patch.outline.size() - 1, patch.outline.back()}};
  for (const auto& [i, j] : division.diagonals) {
    const auto run = std::find_if(runs.rbegin(), runs.rend(), [i = i, j = j](const Run& r) {
      return r.first <= i && j <= r.last;
    });
    const Index dart =
        graph.connect(patch.outline[i], j == run->last ? run->closing : patch.outline[j]);
    runs.push_back({i, j, DartGraph::opposite(dart)});
  }
}

}  // namespace strake
