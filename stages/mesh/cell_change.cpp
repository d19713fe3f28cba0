#include "stages/mesh/cell_change.h"

#include <algorithm>
#include <limits>

namespace strake {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// No face counts as worse than this, however thin it is now.
constexpr double kWorstShape = 10;
/// Faces may not turn by more than this.
constexpr double kLeastTurnCosine = 0.5;

/// The corners of a cell after some have moved, those that meet only once.
Polygon moved_cell(const PolygonGraph& graph, Index cell, const Moves& moves) {
  Polygon after;
  for (const Index d : graph.cell(cell)) {
    const Index node = graph.graph().from(d);
    const Vec3* moved = moves.find(node);
    const Vec3& at = moved != nullptr ? *moved : graph.position(node);
    if (after.empty() || (after.back() != at && after.front() != at)) after.push_back(at);
  }
  return after;
}

}  // namespace

const Vec3* Moves::find(Index node) const {
  for (const auto& [moved, to] : moves_) {
    if (moved == node) return &to;
  }
  return nullptr;
}

double penalty_now(const Polygon& p) {
  return std::min(shape_penalty(p, vector_area(p)), kWorstShape);
}

double changed_penalty(const Polygon& p, const Vec3& normal_before) {
  const Vec3 normal = vector_area(p);
  const double area = normal.norm();
  if (!(normal.dot(normal_before) > kLeastTurnCosine * area * normal_before.norm())) {
    return kInfinity;
  }
  for (std::size_t i = 0; i < p.size(); ++i) {
    if (is_reflex(p, i, normal / area)) return kInfinity;
  }
  return shape_penalty(p, normal_before);
}

std::vector<Index> cells_around(const PolygonGraph& graph, const std::vector<Index>& darts) {
  std::vector<Index> names;
  for (const Index first : darts) {
    Index d = first;
    do {
      if (!graph.is_hole(d)) names.push_back(graph.name_of_cell(d));
      d = graph.graph().rotate_ccw(d);
    } while (d != first);
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

double gain_of_moves(const PolygonGraph& graph, const std::vector<Index>& cells, const Moves& moves,
                     double worst) {
  double gain = 0;
  for (const Index cell : cells) {
    const Polygon before = corner_positions(graph, graph.cell(cell));
    const double penalty_before = penalty_now(before);
    gain += penalty_before;
    const Polygon after = moved_cell(graph, cell, moves);
    if (after.size() < 3) continue;
    const double penalty = changed_penalty(after, vector_area(before));
    if (!(penalty <= std::max(worst, penalty_before))) return -kInfinity;
    gain -= penalty;
  }
  return gain;
}

}  // namespace strake
