#include "stages/mesh/simplify.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/segment.h"

namespace strake {
namespace {

/// Feature and boundary edges are divided where their course leaves the straight edge by more than
/// this share of the local size.
constexpr double kLargestSagitta = 0.06;
/// Likewise of an edge on no barrier, as a share of the straight way: arcs of 130 degrees.
constexpr double kMostBent = 0.32;
/// A face may not turn by more than this when one of its nodes moves.
constexpr double kLeastTurnCosine = 0.3;
/// Free ends of features are near the last crossing within this share of the way to the one before.
constexpr double kNearFreeEnd = 0.7;
/// Corners of the feature graph are only merged below this share of the wanted edge length.
constexpr double kShortestCornerEdge = 0.1;

Vec3 newell_after_move(const PolygonGraph& graph, const DartLoop& cell, Index moved,
                       const Vec3& target) {
  Vec3 normal = Vec3::Zero();
  const auto at = [&](std::size_t i) -> const Vec3& {
    const Index n = graph.graph().from(cell[i]);
    return n == moved ? target : graph.position(n);
  };
  for (std::size_t i = 0; i < cell.size(); ++i) normal += at(i).cross(at((i + 1) % cell.size()));
  return normal;
}

/// Sum of the unit normals of the surface at a cell's corners, one of them moved; zero where all
/// are on features or boundaries: the normal there may be that of the other side.
Vec3 surface_normal(const PolygonGraph& graph, const DartLoop& cell, Index moved, Index target) {
  Vec3 sum = Vec3::Zero();
  for (const Index d : cell) {
    const Index n = graph.graph().from(d) == moved ? target : graph.graph().from(d);
    if (graph.rank(n) == NodeRank::line) sum += graph.surface_normal(n);
  }
  return sum;
}

bool keeps_faces(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  const Vec3& target = graph.position(g.to(dart));
  for (Index d = g.rotate_ccw(dart); d != dart; d = g.rotate_ccw(d)) {
    if (graph.is_hole(d)) continue;
    const DartLoop cell = graph.cell(d);
    if (cell.size() == 3 && (g.to(d) == g.to(dart) || g.from(g.prev(d)) == g.to(dart))) continue;
    const Vec3 before = newell_after_move(graph, cell, kNone, target);
    const Vec3 after = newell_after_move(graph, cell, g.from(dart), target);
    if (after.dot(before) < kLeastTurnCosine * after.norm() * before.norm()) return false;
    if (!(after.norm() > 0.02 * before.norm())) return false;
    // Many small turns would turn a small closed component inside out.
    const Vec3 outward = surface_normal(graph, cell, g.from(dart), g.to(dart));
    if (before.dot(surface_normal(graph, cell, kNone, kNone)) > 0 && !outward.isZero(0) &&
        !(after.dot(outward) > 0)) {
      return false;
    }
  }
  return true;
}

/// Wanted length of an edge: the smaller one of those at its ends.
double size_at_edge(const PolygonGraph& graph, const LocalSize& size, Index dart) {
  const DartGraph& g = graph.graph();
  return std::min(size(graph.node(g.from(dart))), size(graph.node(g.to(dart))));
}

/// How far the corner from(dart) lies off the features and boundaries around to(dart) once it is
/// merged into that.
double distance_once_merged(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  const Vec3& corner = graph.position(g.from(dart));
  const Vec3& apex = graph.position(g.to(dart));
  double least = (corner - apex).norm();
  for (const Index start : {dart, DartGraph::opposite(dart)}) {
    for (Index d = g.rotate_ccw(start); d != start; d = g.rotate_ccw(d)) {
      if (!graph.is_barrier(d)) continue;
      least = std::min(least, way_to_segment(corner, apex, graph.position(g.to(d))).norm());
    }
  }
  return least;
}

/// Dissolves a node of degree two where that leaves polygons with distinct edges.
bool try_dissolve(PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  if (graph.rank(g.from(dart)) != NodeRank::line) return false;
  // Not by the degree: of thousands it would be counted again and again.
  if (g.rotate_ccw(dart) == dart || g.rotate_ccw(g.rotate_ccw(dart)) != dart) return false;
  const Index first = g.prev(dart);
  const Index a = g.from(first);
  const Index b = g.to(dart);
  if (a == b || graph.find_edge(first, b) != kNone) return false;
  if (graph.cell(dart).size() < 4 || graph.cell(DartGraph::opposite(dart)).size() < 4) return false;
  graph.dissolve(dart);
  return true;
}

bool on_boundary(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  Index d = dart;
  do {
    if (graph.kind(d) == EdgeKind::boundary) return true;
    d = g.rotate_ccw(d);
  } while (d != dart);
  return false;
}

bool only_one_edge_to(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  for (Index d = g.rotate_ccw(dart); d != dart; d = g.rotate_ccw(d)) {
    if (g.to(d) == g.to(dart) || g.to(d) == g.from(d)) return false;
  }
  return true;
}

/// Whether merging from(dart) into to(dart) leaves two cells with the same corners, as it does in a
/// tetrahedron.
bool puts_cells_back_to_back(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  struct Cell {
    std::vector<Index> corners;  // ascending
    Index name;
  };
  std::vector<Cell> cells;
  for (const Index start : {dart, DartGraph::opposite(dart)}) {
    Index d = start;
    do {
      if (graph.is_hole(d)) continue;
      std::vector<Index> corners;
      for (const Index side : graph.cell(d)) {
        corners.push_back(g.from(side) == g.from(dart) ? g.to(dart) : g.from(side));
      }
      std::sort(corners.begin(), corners.end());
      corners.erase(std::unique(corners.begin(), corners.end()), corners.end());
      if (corners.size() < 3) continue;  // vanishes
      const Index name = graph.name_of_cell(d);
      const auto same =
          std::ranges::find_if(cells, [&](const Cell& cell) { return cell.corners == corners; });
      if (same == cells.end()) {
        cells.push_back({std::move(corners), name});
      } else if (same->name != name) {
        return true;
      }
    } while ((d = g.rotate_ccw(d)) != start);
  }
  return false;
}

/// Brings the last crossing of a feature that ends freely to its end, where that is near; what ends
/// farther away goes, as in [MK04] section 5, up to the last crossing.
void settle_free_ends(PolygonGraph& graph, SimplifyCounts& counts) {
  const DartGraph& g = graph.graph();
  const auto is_near = [&](Index dart) {
    if (!graph.is_barrier(dart) || graph.rank(g.from(dart)) != NodeRank::barrier) return false;
    for (Index d = g.rotate_ccw(dart); d != dart; d = g.rotate_ccw(d)) {
      if (graph.is_barrier(d)) return graph.length(dart) < kNearFreeEnd * graph.length(d);
    }
    return false;
  };
  g.take_back_free_ends([&](Index d) {
    if (is_near(d) && can_contract(graph, d)) {
      graph.contract(d);
      ++counts.contracted_edges;
      return false;
    }
    graph.remove_edge(d);
    return true;
  });
}

/// Removes the bigons beside an edge that is about to vanish or has vanished.
void clean_up(PolygonGraph& graph, std::initializer_list<Index> darts, SimplifyCounts& counts) {
  for (const Index d : darts) {
    if (!graph.graph().is_alive(d)) continue;
    const Index n = graph.graph().next(d);
    if (remove_bigon(graph, d)) {
      ++counts.removed_bigons;
      for (const Index end : {d, n}) {
        if (graph.graph().is_alive(end) && try_dissolve(graph, end)) ++counts.dissolved_nodes;
      }
    }
  }
}

void contract_edge(PolygonGraph& graph, Index dart, SimplifyCounts& counts) {
  const Index left = graph.graph().next(dart);
  const Index right = graph.graph().next(DartGraph::opposite(dart));
  graph.contract(dart);
  ++counts.contracted_edges;
  clean_up(graph, {left, right}, counts);
}

void contract_short_edges(PolygonGraph& graph, const LocalSize& size, const SimplifyLimits& limits,
                          SimplifyCounts& counts) {
  const DartGraph& g = graph.graph();
  std::vector<std::pair<double, Index>> candidates;
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d)) continue;
    const double ratio =
        (graph.position(g.from(d)) - graph.position(g.to(d))).norm() / size_at_edge(graph, size, d);
    const bool between_corners =
        graph.rank(g.from(d)) == NodeRank::corner && graph.rank(g.to(d)) == NodeRank::corner;
    const double shortest = limits.shortest;
    if (ratio < (between_corners ? std::min(shortest, kShortestCornerEdge) : shortest)) {
      candidates.emplace_back(ratio, d);
    }
  }
  std::sort(candidates.begin(), candidates.end());
  for (const auto& [ratio, even] : candidates) {
    if (!g.is_alive(even)) continue;
    Index dart = even;
    const auto firmer = [&](Index d) {  // whether the origin should rather stay
      const NodeRank a = graph.rank(g.from(d));
      const NodeRank b = graph.rank(g.to(d));
      return a != b ? a > b : graph.degree(d) > graph.degree(DartGraph::opposite(d));
    };
    if (firmer(dart)) dart = DartGraph::opposite(dart);
    if (!can_contract(graph, dart)) {
      dart = DartGraph::opposite(dart);
      if (!can_contract(graph, dart)) continue;
    }
    if (graph.rank(g.from(dart)) == NodeRank::corner &&
        distance_once_merged(graph, dart) >
            limits.corner_distance * size_at_edge(graph, size, dart)) {
      continue;
    }
    contract_edge(graph, dart, counts);
  }
}

/// Barriers stay as near to their course as cells are large; other lines do not cut a bore or a
/// tip off.
void divide_bent_edges(PolygonGraph& graph, const LocalSize& size, SimplifyCounts& counts) {
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); d += 2) {  // new edges come last and are looked at too
    if (!g.is_alive(d) || g.from(d) == g.to(d)) continue;
    const double chord = (graph.position(g.to(d)) - graph.position(g.from(d))).norm();
    const double largest =
        graph.is_barrier(d) ? kLargestSagitta * size_at_edge(graph, size, d) : kMostBent * chord;
    const PolygonGraph::Bend bend = graph.bend(d);
    if (!(bend.distance > largest)) continue;
    graph.split(d, bend.share);
    ++counts.split_edges;
    d -= 2;  // the first half again
  }
}

/// Joins a node to the corner of the cell left of a dart that leaves it that is farthest from it
/// along the outline.
void join_across(PolygonGraph& graph, Index dart) {
  const DartLoop cell = graph.cell(dart);
  const Index node = graph.graph().from(dart);
  double around = 0;
  for (const Index d : cell) around += graph.length(d);
  double way = 0;
  double farthest = 0;
  Index best = kNone;
  for (const Index d : cell) {
    const double away = std::min(way, around - way);
    way += graph.length(d);
    if (away <= farthest || graph.find_edge(dart, graph.graph().from(d)) != kNone) continue;
    farthest = away;
    best = d;
  }
  if (best != kNone && graph.graph().from(best) != node) graph.connect(dart, best);
}

/// Removes lines around cells that are so small that dividing them in three would leave edges that
/// are too short, as around the tip of a cone. Their nodes are at the tip then.
void remove_small_loops(PolygonGraph& graph, const LocalSize& size, double shortest,
                        SimplifyCounts& counts) {
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (!g.is_alive(d) || g.next(d) != d || graph.is_barrier(d) || graph.is_hole(d)) continue;
    if (graph.length(d) / 3 >= shortest * size_at_edge(graph, size, d)) continue;
    if (graph.degree(d) != 4) continue;  // what ends in the loop would end nowhere
    const Index first = g.next(DartGraph::opposite(d));
    graph.remove_edge(d);
    ++counts.removed_loops;
    for (const Index leaving : {first, g.rotate_ccw(first)}) join_across(graph, leaving);
  }
}

/// Divides loops in three and all but one of several edges between two nodes in two.
void separate_edges(PolygonGraph& graph, SimplifyCounts& counts) {
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (!g.is_alive(d)) continue;
    if (g.from(d) == g.to(d)) {
      const Index rest = graph.split(d, 1.0 / 3);
      graph.split(rest, 0.5);
      counts.split_edges += 2;
      continue;
    }
    for (Index other = g.rotate_ccw(d); other != d; other = g.rotate_ccw(other)) {
      if (g.to(other) != g.to(d)) continue;
      const bool prefer_other = graph.length(other) >= graph.length(d);
      graph.split(prefer_other ? other : d, 0.5);
      ++counts.split_edges;
      break;
    }
  }
}

}  // namespace

bool remove_bigon(PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  const Index other = g.next(dart);
  if (g.next(other) != dart || g.from(dart) == g.to(dart)) return false;
  if (DartGraph::edge_of(dart) == DartGraph::edge_of(other)) return false;
  const auto weight = [&](Index d) {
    return (graph.is_barrier(d) ? 2 : 0) + (graph.kind(d) == EdgeKind::line ? 1 : 0);
  };
  const Index weaker = weight(dart) <= weight(other) ? dart : other;
  if (graph.is_barrier(weaker)) return false;
  graph.remove_edge(weaker);
  return true;
}

bool keeps_topology(const PolygonGraph& graph, Index dart) {
  const DartGraph& g = graph.graph();
  const Index u = g.from(dart);
  const Index v = g.to(dart);
  if (u == v || graph.rank(u) > graph.rank(v)) return false;
  if (graph.is_kept(u) || graph.is_kept(v)) return false;
  if (graph.rank(u) != NodeRank::line && !graph.is_barrier(dart)) return false;
  // A feature edge between two boundary nodes: contracting it would pinch the surface.
  if (graph.kind(dart) != EdgeKind::boundary && on_boundary(graph, dart) &&
      on_boundary(graph, DartGraph::opposite(dart))) {
    return false;
  }
  if (!only_one_edge_to(graph, dart) || !only_one_edge_to(graph, DartGraph::opposite(dart)))
    return false;
  int triangles = 0;
  for (const Index side : {dart, DartGraph::opposite(dart)}) {
    const DartLoop cell = graph.cell(side);
    if (cell.size() < 3) return false;
    if (cell.size() > 3) continue;
    ++triangles;
    if (graph.is_hole(side)) return false;
    if (graph.is_barrier(cell[1]) && graph.is_barrier(cell[2])) return false;
  }
  int common = 0;  // neighbours of both ends
  for (Index d = g.rotate_ccw(dart); d != dart; d = g.rotate_ccw(d)) {
    if (graph.find_edge(DartGraph::opposite(dart), g.to(d)) != kNone) ++common;
  }
  if (common != triangles) return false;
  // A cell that has both ends elsewhere on its outline would be pinched.
  const DartLoop left = graph.cell(dart);
  const DartLoop right = graph.cell(DartGraph::opposite(dart));
  for (Index d = g.rotate_ccw(dart); d != dart; d = g.rotate_ccw(d)) {
    if (std::find(left.begin(), left.end(), d) != left.end() ||
        std::find(right.begin(), right.end(), d) != right.end()) {
      continue;
    }
    const DartLoop cell = graph.cell(d);
    for (const Index other : cell) {
      if (g.from(other) == v) return false;
    }
  }
  return !puts_cells_back_to_back(graph, dart);
}

bool can_contract(const PolygonGraph& graph, Index dart) {
  return keeps_topology(graph, dart) && keeps_faces(graph, dart);
}

SimplifyCounts contract_edge(PolygonGraph& graph, Index dart) {
  SimplifyCounts counts;
  contract_edge(graph, dart, counts);
  return counts;
}

SimplifyCounts simplify(PolygonGraph& graph, const LocalSize& size, const SimplifyLimits& limits) {
  SimplifyCounts counts;
  const DartGraph& g = graph.graph();
  settle_free_ends(graph, counts);
  for (Index d = 0; d < g.dart_count(); ++d) clean_up(graph, {d}, counts);
  for (int pass = 0; pass < 3; ++pass) {
    const Index before = counts.contracted_edges;
    contract_short_edges(graph, size, limits, counts);
    if (counts.contracted_edges == before) break;
  }
  for (Index d = 0; d < g.dart_count(); ++d) {
    if (g.is_alive(d) && try_dissolve(graph, d)) ++counts.dissolved_nodes;
  }
  remove_small_loops(graph, size, limits.shortest, counts);
  separate_edges(graph, counts);
  divide_bent_edges(graph, size, counts);
  return counts;
}

}  // namespace strake
