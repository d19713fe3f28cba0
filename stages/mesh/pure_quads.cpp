#include "stages/mesh/pure_quads.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <queue>
#include <tuple>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "stages/mesh/cell_shape.h"
#include "stages/mesh/strip.h"

namespace strake {
namespace {

/// Prices of one step of a way.
constexpr int kStraight = 2;
constexpr int kTurn = 5;     ///< makes a vertex of valence 3 and one of valence 5
constexpr int kBarrier = 6;  ///< more, for another vertex on a feature or boundary
/// How far the new corner of a triangle moves off its edge, as a share of that edge, so that it is
/// convex.
constexpr double kCornerBulge = 1e-2;

std::size_t sides(const PolygonGraph& graph, Index dart) { return graph.cell(dart).size(); }

/// The cheapest way out of an odd face to another one or off the boundary, as the darts it crosses,
/// each with the cell that is left on its left. Empty where there is none.
std::vector<Index> cheapest_way(const PolygonGraph& graph, Index start) {
  const DartGraph& g = graph.graph();
  struct Step {
    int price;
    Index dart;  ///< crossed last
    bool operator>(const Step& other) const {
      return std::tie(price, dart) > std::tie(other.price, other.dart);
    }
  };
  std::priority_queue<Step, std::vector<Step>, std::greater<>> open;
  std::unordered_map<Index, Index> before;  // dart -> dart crossed before it
  std::unordered_set<Index> reached = {graph.name_of_cell(start)};
  const auto push = [&](int price, Index dart, Index previous) {
    if (!before.try_emplace(dart, previous).second) return;
    open.push({price + (graph.is_barrier(dart) ? kBarrier : 0), dart});
  };
  for (const Index d : graph.cell(start)) {
    if (can_halve(graph, d)) push(kStraight, d, kNone);
  }
  while (!open.empty()) {
    const auto [price, dart] = open.top();
    open.pop();
    const Index across = DartGraph::opposite(dart);
    const bool outside = graph.is_outer(across);
    if (!outside && !reached.insert(graph.name_of_cell(across)).second) continue;
    if (outside || sides(graph, across) % 2 == 1) {
      std::vector<Index> way;
      for (Index d = dart; d != kNone; d = before.at(d)) way.push_back(d);
      std::reverse(way.begin(), way.end());
      return way;
    }
    const Index left = g.next(across);
    push(price + kTurn, left, dart);
    push(price + kStraight, g.next(left), dart);
    push(price + kTurn, g.next(g.next(left)), dart);
  }
  return {};
}

/// Divides the odd face that the dart from a new node on its outline leaves into.
void divide_odd(PolygonGraph& graph, Index leaving) {
  const DartGraph& g = graph.graph();
  const DartLoop cell = graph.cell(leaving);
  if (cell.size() == 6) {
    graph.connect(leaving, cell[3]);
    return;
  }
  const Index node = g.from(leaving);
  if (graph.rank(node) != NodeRank::line) return;
  const Polygon p = corner_positions(graph, cell);
  const Vec3 along = p[1] - p[3];
  const Vec3 outwards = along.cross(vector_area(p));
  if (outwards.norm() > 0) {
    graph.move(node, p[0] + kCornerBulge * along.norm() * outwards.normalized());
  }
}

/// Divides a quad from the new node on one of its edges to that on another one.
/// \param in, out  the darts that leave these nodes in the cell
void divide_quad(PolygonGraph& graph, Index in, Index out) {
  const DartGraph& g = graph.graph();
  const DartLoop cell = graph.cell(in);
  const std::size_t at =
      static_cast<std::size_t>(std::find(cell.begin(), cell.end(), out) - cell.begin());
  if (at == 3) {
    graph.connect(in, out);
    return;
  }
  // A turn: the corner across from the one it goes around.
  Polygon corners;
  for (std::size_t i = 1; i < cell.size(); ++i) {
    if (i != at) corners.push_back(graph.position(g.from(cell[i])));
  }
  Vec3 middle = Vec3::Zero();
  for (const Vec3& p : corners) middle += p / 4;
  const Index across = cell[at == 2 ? 4 : 2];
  const Index way = graph.connect(in, out);
  const Index second = graph.split(way, 0.5);
  const Index node = g.from(second);
  graph.move(node, middle);
  const Index leaving = at == 2 ? second : DartGraph::opposite(g.prev(second));
  graph.connect(leaving, across);
}

void split_along(PolygonGraph& graph, const std::vector<Index>& way) {
  const DartGraph& g = graph.graph();
  Index ahead = kNone;  // leaves the last new node into the cell ahead
  for (const Index dart : way) {
    const Index leaving = graph.split(dart, 0.5);
    const Index next_ahead = DartGraph::opposite(g.prev(leaving));
    if (ahead == kNone) {
      divide_odd(graph, leaving);
    } else {
      divide_quad(graph, ahead, leaving);
    }
    ahead = next_ahead;
  }
  if (!graph.is_outer(ahead)) divide_odd(graph, ahead);
}

}  // namespace

Index join_odd_faces(PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  Index joined = 0;
  for (Index d = 0; d < g.dart_count(); ++d) {  // new cells have new darts
    if (!g.is_alive(d) || graph.is_hole(d) || sides(graph, d) % 2 == 0) continue;
    const std::vector<Index> way = cheapest_way(graph, d);
    if (way.empty()) continue;
    split_along(graph, way);
    ++joined;
  }
  return joined;
}

void divide_into_quads(PolygonGraph& graph, const std::function<bool(Index)>& is_divided) {
  const DartGraph& g = graph.graph();
  std::vector<Index> edges;
  std::vector<DartLoop> cells;
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (g.is_alive(d) && is_divided(d)) edges.push_back(d);
  }
  graph.for_each_cell([&](Index d, const DartLoop& cell) {
    if (is_divided(d)) cells.push_back(cell);
  });
  for (const Index edge : edges) graph.split(edge, 0.5);
  for (const DartLoop& corners : cells) {
    const DartLoop cell = graph.cell(corners.front());
    const auto starts_at_middle = [&](Index d) {
      return std::ranges::find(corners, d) == corners.end();
    };
    Vec3 inside = Vec3::Zero();
    for (const Index d : corners) inside += graph.position(g.from(d)) / corners.size();
    Index leaving = kNone;  // the node inside, for the middle reached last
    Index first = kNone;
    for (const Index d : cell) {
      if (!starts_at_middle(d)) continue;
      if (first == kNone) {
        first = d;
      } else if (leaving == kNone) {
        leaving = graph.split(graph.connect(first, d), 0.5);
        graph.move(g.from(leaving), inside);
      } else {
        leaving = graph.connect(leaving, d);
      }
    }
  }
}

}  // namespace strake
