#include "stages/mesh/flat_parts.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/face_crossings/box_tree.h"
#include "stages/mesh/cell_shape.h"

namespace strake {
namespace {

using Plane = Eigen::Hyperplane<double, 3>;

/// Corners of a cell may be off the plane by this share of its circumference.
constexpr double kFlat = 0.01;
/// Crossings for each cell of a part from which on it is no drawing that could be mended.
constexpr std::size_t kTangle = 20;
/// Corners around a node that turn by more are in another order than their darts.
constexpr double kFullTurn = 2 * M_PI + 1e-6;

BoxTree::Box box_around(const Vec2& a, const Vec2& b) {
  const Vec2 low = a.cwiseMin(b);
  const Vec2 high = a.cwiseMax(b);
  return {Vec3(low.x(), low.y(), 0), Vec3(high.x(), high.y(), 0)};
}

bool lies_in(const Plane& plane, const Polygon& p) {
  double around = 0;
  for (std::size_t i = 0; i < p.size(); ++i) around += (p[(i + 1) % p.size()] - p[i]).norm();
  return std::ranges::all_of(
      p, [&](const Vec3& corner) { return plane.absDistance(corner) <= kFlat * around; });
}

}  // namespace

FlatParts::FlatParts(const PolygonGraph& graph) : graph_(graph) {
  const DartGraph& g = graph.graph();
  part_of_.assign(g.dart_count(), kNone);
  cell_of_.assign(g.dart_count(), kNone);
  std::vector<std::pair<double, Index>> seeds;  // the largest cells first
  graph.for_each_cell([&](Index d, const DartLoop& cell) {
    const double area = vector_area(corner_positions(graph, cell)).norm();
    if (area > 0) seeds.emplace_back(-area, d);
  });
  std::ranges::sort(seeds);
  std::vector<char> taken(g.dart_count(), 0);
  for (const auto& [area, d] : seeds) {
    if (taken[d] != 0) continue;
    std::vector<Index> cells = grow(d, taken);
    if (cells.size() < 2) continue;
    parts_.emplace_back().cells = std::move(cells);
    update(size() - 1);
  }
}

std::vector<Index> FlatParts::grow(Index first, std::vector<char>& taken) const {
  const auto take = [&](const DartLoop& cell) {
    for (const Index d : cell) taken[d] = 1;
  };
  const Polygon corners = corner_positions(graph_, graph_.cell(first));
  const Plane plane(vector_area(corners).normalized(), corners.front());
  if (!lies_in(plane, corners)) return {};
  std::vector<Index> cells = {first};
  take(graph_.cell(first));
  for (std::size_t at = 0; at < cells.size(); ++at) {
    for (const Index d : graph_.cell(cells[at])) {
      const Index other = DartGraph::opposite(d);
      if (graph_.is_barrier(d) || taken[other] != 0) continue;
      const DartLoop cell = graph_.cell(other);
      if (!lies_in(plane, corner_positions(graph_, cell))) continue;
      cells.push_back(other);
      take(cell);
    }
  }
  return cells;
}

bool FlatParts::is_inside(Index part, Index dart) const {
  return !graph_.is_barrier(dart) && has(part, dart) && has(part, DartGraph::opposite(dart));
}

std::vector<Index> FlatParts::darts(Index part) const {
  std::vector<Index> found;
  for (const Index cell : cells(part)) {
    const DartLoop loop = graph_.cell(cell);
    found.insert(found.end(), loop.begin(), loop.end());
  }
  return found;
}

FlatParts::Crossings FlatParts::outline_crossings(Index part) const {
  return crossings(part, false);
}

FlatParts::Crossings FlatParts::crossings(Index part) const { return crossings(part, true); }

FlatParts::Crossings FlatParts::crossings(Index part, bool with_inside) const {
  struct Segment {
    Index dart;
    Index from;
    Index to;
    Vec2 a;
    Vec2 b;
  };
  const DartGraph& g = graph_.graph();
  std::vector<Segment> segments;
  std::vector<BoxTree::Box> boxes;
  for (const Index d : darts(part)) {
    const Index other = DartGraph::opposite(d);
    if (d > other && has(part, other)) continue;  // once for both
    if (!with_inside && is_inside(part, d)) continue;
    segments.push_back({d, g.from(d), g.to(d), place(part, g.from(d)), place(part, g.to(d))});
    boxes.push_back(box_around(segments.back().a, segments.back().b));
  }
  const BoxTree tree(boxes);
  Crossings pairs;
  for (std::size_t i = 0; i < segments.size() && !is_tangle(part, pairs); ++i) {
    const Segment& s = segments[i];
    tree.visit_touching(boxes[i], [&](Index j) {
      if (j <= static_cast<Index>(i)) return;
      const Segment& t = segments[j];
      if (s.from == t.from || s.from == t.to || s.to == t.from || s.to == t.to) return;
      if (segments_meet(s.a, s.b, t.a, t.b)) pairs.emplace_back(s.dart, t.dart);
    });
  }
  return pairs;
}

bool FlatParts::is_tangle(Index part, const Crossings& crossings) const {
  return crossings.size() > kTangle * cells(part).size();
}

std::vector<Index> FlatParts::turned(Index part) const {
  const DartGraph& g = graph_.graph();
  std::vector<std::pair<Index, double>> angles;  // nodes and corners at them
  for (const Index cell : cells(part)) {
    const DartLoop loop = graph_.cell(cell);
    Polygon corners;
    for (const Index d : loop) {
      const Vec2 at = place(part, g.from(d));
      corners.emplace_back(at.x(), at.y(), 0);
    }
    const bool is_turned = !(vector_area(corners).z() > 0);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const double angle = is_turned ? 2 * kFullTurn : interior_angle(corners, i, Vec3::UnitZ());
      angles.emplace_back(g.from(loop[i]), angle);
    }
  }
  std::ranges::sort(angles);
  std::vector<Index> nodes;
  for (std::size_t i = 0; i < angles.size();) {
    const Index node = angles[i].first;
    double sum = 0;
    for (; i < angles.size() && angles[i].first == node; ++i) sum += angles[i].second;
    if (sum > kFullTurn) nodes.push_back(node);
  }
  std::vector<Index> found;
  if (nodes.empty()) return found;
  for (const Index d : darts(part)) {
    if (std::ranges::binary_search(nodes, g.from(d))) found.push_back(d);
  }
  return found;
}

void FlatParts::update(Index part) {
  const DartGraph& g = graph_.graph();
  part_of_.resize(g.dart_count(), kNone);
  cell_of_.resize(g.dart_count(), kNone);
  Part& p = parts_[part];
  Vec3 area = Vec3::Zero();  // that of its outline: cells turned over cancel
  for (const Index cell : p.cells) {
    const DartLoop loop = graph_.cell(cell);
    for (const Index d : loop) {
      part_of_[d] = part;
      cell_of_[d] = cell;
    }
    area += vector_area(corner_positions(graph_, loop));
  }
  p.frame = tangent_frame(area.normalized());
  p.origin = graph_.position(g.from(p.cells.front()));
}

void FlatParts::replace(Index part, const std::vector<Index>& old, const std::vector<Index>& made) {
  std::vector<Index> gone = old;
  std::ranges::sort(gone);
  std::vector<Index>& cells = parts_[part].cells;
  std::erase_if(cells, [&](Index cell) { return std::ranges::binary_search(gone, cell); });
  cells.insert(cells.end(), made.begin(), made.end());
  update(part);
}

}  // namespace strake
