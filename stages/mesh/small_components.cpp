#include "stages/mesh/small_components.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <queue>
#include <utility>

#include "stages/mesh/cell_shape.h"
#include "stages/mesh/simplify.h"

namespace strake {
namespace {

/// The sum of squared distances of a point (x, y, z, 1) from planes.
using Quadric = Eigen::Matrix4d;

/// Share of the fourth power of an edge that is added to what its merging costs: in flats, where
/// nothing else costs anything, short edges go first.
constexpr double kShortFirst = 1e-10;

class SmallComponents {
 public:
  SmallComponents(PolygonGraph& graph, const std::vector<Index>& component,
                  const std::vector<double>& cells)
      : graph_(graph),
        component_(component),
        surplus_(cells),
        apex_(cells.size(), Vec3::Zero()),
        quadric_(graph.node_count(), Quadric::Zero()),
        changes_(graph.node_count(), 0) {
    find_surplus();
    graph_.for_each_cell([&](Index d, const DartLoop& cell) {
      if (is_small(graph_.graph().from(d))) add_planes(cell);
    });
    // Edges of triangles are straight, and will be between other nodes.
    for_each_small([&](Index d) {
      if (!graph_.is_barrier(d)) graph_.straighten(d);
    });
  }

  Index run() {
    Index all = 0;
    for (Index merged = 1; merged > 0; all += merged) {  // again: what others allow by now
      for_each_small([&](Index d) { offer(d); });
      merged = merge_offered();
    }
    for_each_small([&](Index d) { graph_.keep(graph_.graph().from(d)); });
    return all;
  }

 private:
  /// Merging from(dart) into to(dart), as long as neither has changed since.
  struct Offer {
    double cost;
    Index dart;
    Index changes;  ///< of both ends, up to when the offer was made

    bool operator<(const Offer& other) const {  // the cheapest is the largest
      return std::pair(cost, dart) > std::pair(other.cost, other.dart);
    }
  };

  [[nodiscard]] Index component_of(Index node) const {
    return component_[graph_.node(node).at.face];
  }
  [[nodiscard]] bool is_small(Index node) const {
    return std::isfinite(surplus_[component_of(node)]);
  }
  /// Calls use(dart) for all darts of small components, ascending.
  void for_each_small(const auto& use) const {
    const DartGraph& g = graph_.graph();
    for (Index d = 0; d < g.dart_count(); ++d) {
      if (g.is_alive(d) && is_small(g.from(d))) use(d);
    }
  }
  /// Whether there are too many nodes in its component.
  [[nodiscard]] bool has_too_many(Index node) const { return surplus_[component_of(node)] >= 1; }

  [[nodiscard]] Index changes(Index dart) const {
    return changes_[graph_.graph().from(dart)] + changes_[graph_.graph().to(dart)];
  }
  [[nodiscard]] bool is_valid(const Offer& offer) const {
    return graph_.graph().is_alive(offer.dart) && changes(offer.dart) == offer.changes &&
           has_too_many(graph_.graph().from(offer.dart));
  }

  /// Nodes that are too many: F quads have F + chi of them, and half a node for each boundary edge,
  /// where chi are nodes less edges and cells as they are now.
  void find_surplus() {
    const DartGraph& g = graph_.graph();
    for (double& surplus : surplus_) surplus = -surplus;
    for (Index d = 0; d < g.dart_count(); ++d) {
      if (!g.is_alive(d)) continue;
      const Index c = component_of(g.from(d));
      surplus_[c] += graph_.kind(d) == EdgeKind::boundary ? 0.25 : 0.5;
      apex_[c] = graph_.position(g.from(d));
    }
    graph_.for_each_cell([&](Index d, const DartLoop&) { --surplus_[component_of(g.from(d))]; });
  }

  /// Merges what is offered, the cheapest first. \return number of nodes taken out
  Index merge_offered() {
    Index all = 0;
    while (!offers_.empty()) {
      const Offer best = offers_.top();
      offers_.pop();
      if (is_valid(best) && can_contract(graph_, best.dart)) all += merge(best.dart);
    }
    return all;
  }

  Index merge(Index dart) {
    const DartGraph& g = graph_.graph();
    const Index kept = g.to(dart);
    DartLoop around;
    for (const Index start : {dart, DartGraph::opposite(dart)}) {
      for (Index d = g.rotate_ccw(start); d != start; d = g.rotate_ccw(d)) around.push_back(d);
    }
    quadric_[kept] += quadric_[g.from(dart)];
    const double share = graph_.kind(dart) == EdgeKind::boundary ? 0.5 : 1;
    const Index gone = 1 + contract_edge(graph_, dart).dissolved_nodes;
    surplus_[component_of(kept)] -= share * gone;
    ++changes_[kept];
    for (const Index d : around) {
      offer(d);
      offer(DartGraph::opposite(d));
    }
    return gone;
  }

  /// Where a node is, for quadrics: not far from the origin, also of a tiny component.
  [[nodiscard]] Vec3 local(Index node) const {
    return graph_.position(node) - apex_[component_of(node)];
  }

  void add_plane(const Vec3& normal, const Vec3& point, double weight,
                 std::initializer_list<Index> nodes) {
    const double length = normal.norm();
    if (!(length > 0)) return;
    const Eigen::Vector4d plane(normal.x(), normal.y(), normal.z(), -normal.dot(point));
    const Quadric weighted = weight / (length * length) * plane * plane.transpose();
    for (const Index node : nodes) quadric_[node] += weighted;
  }

  void add_planes(const DartLoop& cell) {
    const DartGraph& g = graph_.graph();
    const Vec3 area = vector_area(corner_positions(graph_, cell));
    for (const Index d : cell) {
      add_plane(area, local(g.from(d)), area.norm(), {g.from(d)});
      if (!graph_.is_barrier(d)) continue;
      const Vec3 way = local(g.to(d)) - local(g.from(d));
      add_plane(way.cross(area), local(g.from(d)), way.squaredNorm(), {g.from(d), g.to(d)});
    }
  }

  void offer(Index dart) {
    if (!graph_.graph().is_alive(dart)) return;
    const Index from = graph_.graph().from(dart);
    const Index to = graph_.graph().to(dart);
    if (!has_too_many(from) || graph_.rank(from) == NodeRank::corner ||
        graph_.rank(from) > graph_.rank(to)) {
      return;
    }
    const Eigen::Vector4d place = local(to).homogeneous();
    const double square = (local(to) - local(from)).squaredNorm();
    const double off = place.dot((quadric_[from] + quadric_[to]) * place);
    offers_.push({std::max(0.0, off) + kShortFirst * square * square, dart, changes(dart)});
  }

  PolygonGraph& graph_;
  const std::vector<Index>& component_;  ///< [F]
  std::vector<double> surplus_;          ///< [components] nodes that are too many
  std::vector<Vec3> apex_;               ///< [components] one of the nodes
  std::vector<Quadric> quadric_;         ///< [nodes]
  std::vector<Index> changes_;           ///< [nodes] times that others were merged into it
  std::priority_queue<Offer> offers_;
};

}  // namespace

Index simplify_small_components(PolygonGraph& graph, const std::vector<Index>& component,
                                const std::vector<double>& cells) {
  return SmallComponents(graph, component, cells).run();
}

}  // namespace strake
