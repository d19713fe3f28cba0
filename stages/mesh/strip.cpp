#include "stages/mesh/strip.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "stages/mesh/cell_change.h"
#include "stages/mesh/cell_shape.h"
#include "stages/mesh/simplify.h"

namespace strake {
namespace {

/// Price of halving an edge that already has the wanted length; none at twice that.
constexpr double kSplitPrice = 0.3;
/// Price of taking an edge of the wanted length away; falls with the square of its length.
constexpr double kCollapsePrice = 0.6;
constexpr double kNever = -std::numeric_limits<double>::infinity();

Vec3 middle(const PolygonGraph& graph, Index dart) { return graph.split_position(dart, 0.5); }

double edge_ratio(const PolygonGraph& graph, Index dart, const EdgeLength& wanted) {
  const DartGraph& g = graph.graph();
  return (graph.position(g.from(dart)) - graph.position(g.to(dart))).norm() / wanted(dart);
}

/// Gain of halving a cell between the middles of two edges, or from one to the opposite corner.
double halving_gain(const PolygonGraph& graph, Index in, Index out) {
  const DartLoop cell = graph.cell(out);
  const Polygon p = corner_positions(graph, cell);
  const Vec3 normal = vector_area(p);
  Polygon whole;  // with the new nodes, starting at the middle of `out`
  std::size_t other = 0;
  whole.push_back(middle(graph, out));
  for (std::size_t i = 1; i <= p.size(); ++i) {
    whole.push_back(p[i % p.size()]);
    if (in != kNone && cell[i % p.size()] == in) {
      other = whole.size();
      whole.push_back(middle(graph, in));
    }
  }
  if (in == kNone) {
    if (p.size() == 3) return penalty_now(p) - changed_penalty(whole, normal);
    other = 3;
  }
  const Polygon one(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(other) + 1);
  Polygon two(whole.begin() + static_cast<std::ptrdiff_t>(other), whole.end());
  two.push_back(whole.front());
  return penalty_now(p) - changed_penalty(one, normal) - changed_penalty(two, normal);
}

/// Whether halving an edge would leave a node of two edges, and two triangles that only count as
/// quads.
bool is_between_triangles(const PolygonGraph& graph, Index dart) {
  const Index other = DartGraph::opposite(dart);
  return !graph.is_outer(other) && graph.cell(dart).size() == 3 && graph.cell(other).size() == 3;
}

/// Where the ends of the rungs meet when a strip is taken out: in the middle, or at the end that is
/// on a feature or boundary. Nothing where both are, or where the strip touches itself.
std::optional<Moves> merging_moves(const PolygonGraph& graph, const Strip& strip) {
  Moves moves;
  for (const Index rung : strip.rungs) {
    const Index a = graph.graph().from(rung);
    const Index b = graph.graph().to(rung);
    const bool a_free = graph.rank(a) == NodeRank::line;
    const bool b_free = graph.rank(b) == NodeRank::line;
    if (graph.is_barrier(rung) || (!a_free && !b_free)) return std::nullopt;
    if (graph.is_kept(a) || graph.is_kept(b)) return std::nullopt;
    if (moves.find(a) != nullptr || moves.find(b) != nullptr) return std::nullopt;
    const Vec3 to = a_free && b_free ? middle(graph, rung) : graph.position(a_free ? b : a);
    moves.add(a, to);
    moves.add(b, to);
  }
  return moves;
}

}  // namespace

std::optional<Strip> follow_strip(const PolygonGraph& graph, Index dart, std::size_t most,
                                  std::vector<char>* crossed) {
  const DartGraph& g = graph.graph();
  Strip strip;
  strip.starts_outside = graph.is_outer(dart);
  const bool starts_in_quad = !strip.starts_outside && graph.cell(dart).size() == 4;
  std::vector<Index> visited;
  if (!strip.starts_outside) visited.push_back(graph.name_of_cell(dart));
  for (Index d = dart;;) {
    strip.rungs.push_back(d);
    if (crossed != nullptr) (*crossed)[DartGraph::edge_of(d)] = 1;
    if (strip.rungs.size() > most) return std::nullopt;
    const Index across = DartGraph::opposite(d);
    strip.ends_outside = graph.is_outer(across);
    if (strip.ends_outside) break;
    const std::size_t sides = graph.cell(across).size();
    const Index next = g.next(g.next(across));
    strip.is_closed = starts_in_quad && sides == 4 && next == dart;
    if (strip.is_closed) return strip;
    const Index name = graph.name_of_cell(across);
    if (std::find(visited.begin(), visited.end(), name) != visited.end()) return std::nullopt;
    if (sides == 3 || sides == 5) break;
    if (sides != 4) return std::nullopt;
    visited.push_back(name);
    d = next;
  }
  if (starts_in_quad) return std::nullopt;
  return strip;
}

bool can_halve(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  const Index other = DartGraph::opposite(dart);
  if (graph.is_outer(other) || graph.cell(dart).size() != 5 || graph.cell(other).size() != 5) {
    return true;
  }
  return g.to(g.next(g.next(dart))) != g.to(g.next(g.next(other)));
}

double split_price(const PolygonGraph& graph, const Strip& strip, const EdgeLength& wanted) {
  double price = 0;
  for (const Index rung : strip.rungs) {
    price += kSplitPrice * std::max(0.0, 2 - edge_ratio(graph, rung, wanted));
  }
  return price;
}

double split_gain(const PolygonGraph& graph, const Strip& strip) {
  // The middles of two rungs around two quads would be joined twice.
  if (strip.is_closed && strip.rungs.size() < 3) return kNever;
  if (strip.rungs.size() == 1) {
    const Index rung = strip.rungs.front();
    if (!can_halve(graph, rung) || is_between_triangles(graph, rung)) return kNever;
  }
  double gain = 0;
  Index before = strip.is_closed ? strip.rungs.back() : kNone;
  for (const Index rung : strip.rungs) {
    const bool is_outside = strip.starts_outside && before == kNone;
    const Index in = before == kNone ? kNone : DartGraph::opposite(before);
    if (!is_outside) gain += halving_gain(graph, in, rung);
    if (!(gain > kNever)) return kNever;
    before = rung;
  }
  if (!strip.ends_outside && !strip.is_closed) {
    gain += halving_gain(graph, kNone, DartGraph::opposite(strip.rungs.back()));
  }
  return gain;
}

void split_strip(PolygonGraph& graph, const Strip& strip) {
  const DartGraph& g = graph.graph();
  const auto connect_across = [&](Index leaving) {  // in an odd face
    if (graph.cell(leaving).size() == 6) {
      graph.connect(leaving, g.next(g.next(g.next(leaving))));
    }
  };
  Index first = kNone;   // dart that leaves the first new node into the cell it came from
  Index behind = kNone;  // dart that leaves the last new node into the cell ahead
  for (const Index rung : strip.rungs) {
    const Index leaving = graph.split(rung, 0.5);
    const Index ahead = DartGraph::opposite(g.prev(leaving));
    if (behind != kNone) {
      graph.connect(behind, leaving);
    } else if (strip.is_closed) {
      first = leaving;
    } else if (!strip.starts_outside) {
      connect_across(leaving);
    }
    behind = ahead;
  }
  if (strip.is_closed) {
    graph.connect(behind, first);
  } else if (!strip.ends_outside) {
    connect_across(behind);
  }
}

double collapse_price(const PolygonGraph& graph, const Strip& strip, const EdgeLength& wanted) {
  double price = 0;
  for (const Index rung : strip.rungs) {
    const double ratio = edge_ratio(graph, rung, wanted);
    price += kCollapsePrice * ratio * ratio;
  }
  return price;
}

double collapse_gain(const PolygonGraph& graph, const Strip& strip) {
  if (strip.starts_outside || strip.ends_outside) return kNever;
  const std::optional<Moves> moves = merging_moves(graph, strip);
  if (!moves) return kNever;
  std::vector<Index> ends;
  for (const Index rung : strip.rungs) {
    ends.push_back(rung);
    ends.push_back(DartGraph::opposite(rung));
  }
  return gain_of_moves(graph, cells_around(graph, ends), *moves,
                       std::numeric_limits<double>::infinity());
}

std::size_t collapse_strip(PolygonGraph& graph, const Strip& strip) {
  const DartGraph& g = graph.graph();
  std::size_t done = 0;
  for (const Index rung : strip.rungs) {
    Index dart = rung;
    const NodeRank a = graph.rank(g.from(dart));
    const NodeRank b = graph.rank(g.to(dart));
    if (a > b) dart = DartGraph::opposite(dart);
    if (!keeps_topology(graph, dart)) return done;
    if (a == b) {
      const Index second = graph.split(dart, 0.5);
      const Index first = g.prev(second);
      // Both ends are merged into the middle.
      const Index back = DartGraph::opposite(second);
      graph.contract(back);
      dart = first;
    }
    const Index left = g.next(dart);
    const Index right = g.next(DartGraph::opposite(dart));
    graph.contract(dart);
    for (const Index side : {left, right}) {
      if (g.is_alive(side)) remove_bigon(graph, side);
    }
    ++done;
  }
  return done;
}

bool claim_strip(const PolygonGraph& graph, const Strip& strip, bool all, ClaimedNodes& claimed) {
  const DartGraph& g = graph.graph();
  std::vector<Index> cells;
  for (const Index rung : strip.rungs) {
    // Where nothing has touched the ends, the rung and the cells at it are what they were.
    if (claimed.has(g.from(rung)) || claimed.has(g.to(rung))) return false;
    const std::vector<Index> sides = {rung, DartGraph::opposite(rung)};
    const std::vector<Index> beside = all ? cells_around(graph, sides) : sides;
    cells.insert(cells.end(), beside.begin(), beside.end());
  }
  DartLoop corners;
  for (const Index dart : cells) {
    if (graph.is_hole(dart)) continue;
    const DartLoop cell = graph.cell(dart);
    corners.insert(corners.end(), cell.begin(), cell.end());
  }
  return claimed.claim(corners);
}

}  // namespace strake
