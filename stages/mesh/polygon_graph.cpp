#include "stages/mesh/polygon_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "common/geometry/face_chart.h"
#include "common/geometry/frames.h"

namespace strake {
namespace {

/// Which overlay nodes become nodes of the polygon graph.
std::vector<char> kept_nodes(const Overlay& overlay, const BorderCourse& borders) {
  const DartGraph& graph = overlay.graph;
  std::vector<Index> degree(overlay.nodes.size(), 0);
  std::vector<Index> some_dart(overlay.nodes.size(), kNone);
  std::vector<char> kept(overlay.nodes.size(), 0);
  for (Index d = 0; d < graph.dart_count(); ++d) {
    if (!graph.is_alive(d)) continue;
    const Index n = graph.from(d);
    ++degree[n];
    if (some_dart[n] != kNone &&
        overlay.kind[DartGraph::edge_of(some_dart[n])] != overlay.kind[DartGraph::edge_of(d)]) {
      kept[n] = 1;
    }
    some_dart[n] = d;
  }
  for (Index n = 0; n < overlay.nodes.size(); ++n) {
    if (degree[n] == 0) continue;
    const Index v = overlay.nodes[n].vertex;
    const EdgeKind kind = overlay.kind[DartGraph::edge_of(some_dart[n])];
    const bool on_barrier = kind == EdgeKind::feature || kind == EdgeKind::boundary;
    if (degree[n] != 2 || (on_barrier && v != kNone && borders.is_corner[v] != 0)) kept[n] = 1;
  }
  // Rings without any such node keep an arbitrary one.
  std::vector<char> seen(overlay.nodes.size(), 0);
  for (Index n = 0; n < overlay.nodes.size(); ++n) {
    if (degree[n] != 2 || kept[n] != 0 || seen[n] != 0) continue;
    bool has_kept = false;
    for (const Index direction : {some_dart[n], graph.rotate_ccw(some_dart[n])}) {
      Index d = direction;
      while (kept[graph.to(d)] == 0 && seen[graph.to(d)] == 0) {
        seen[graph.to(d)] = 1;
        d = graph.next(d);
      }
      has_kept = has_kept || kept[graph.to(d)] != 0;
    }
    if (!has_kept) kept[n] = 1;
    seen[n] = 1;
  }
  return kept;
}

/// A node of the overlay, on the course of the boundary where it is on that.
SurfaceNode placed(const TriMesh& mesh, const BorderCourse& borders, SurfaceNode node) {
  if (borders.offset.empty()) return node;
  node.offset = borders.offset_at(mesh, node.at);
  node.position += node.offset;
  return node;
}

/// From one node to another.
using Side = std::pair<Index, Index>;

std::array<Side, 3> sides(const std::array<Index, 3>& triangle) {
  return {{{triangle[0], triangle[1]}, {triangle[1], triangle[2]}, {triangle[2], triangle[0]}}};
}

/// Whether triangles fill outlines and make a surface with what is around them: each side is that
/// of an outline or of two triangles, and those at a corner of an outline are all there are between
/// its two edges.
bool fit_together(const DartGraph& graph, const std::vector<std::vector<Index>>& outlines,
                  const std::vector<std::array<Index, 3>>& triangles) {
  std::map<Side, Index> across;  // the third corner
  for (const auto& triangle : triangles) {
    for (int i = 0; i < 3; ++i) {
      if (!across.try_emplace(sides(triangle)[i], triangle[(i + 2) % 3]).second) return false;
    }
  }
  std::set<Side> outer;
  std::size_t corners = 0;
  for (const std::vector<Index>& outline : outlines) {
    for (const Index d : outline) {
      if (!outer.insert({graph.from(d), graph.to(d)}).second) return false;
    }
  }
  for (const auto& [from, to] : outer) {
    if (!across.contains({from, to})) return false;
  }
  for (const auto& [side, corner] : across) {
    if (outer.contains(side)) continue;
    const Side back(side.second, side.first);
    if (!across.contains(back) || outer.contains(back)) return false;
  }
  for (const std::vector<Index>& outline : outlines) {
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Index node = graph.from(outline[i]);
      const Index before = graph.from(outline[i > 0 ? i - 1 : outline.size() - 1]);
      Index at = graph.to(outline[i]);
      do {
        at = across.at({node, at});
        ++corners;
      } while (!outer.contains({at, node}));
      if (at != before) return false;
    }
  }
  return corners == 3 * triangles.size();
}

}  // namespace

PolygonGraph::PolygonGraph(const TriMesh& mesh, const Overlay& overlay, const BorderCourse& borders)
    : mesh_(&mesh) {
  const DartGraph& from = overlay.graph;
  const std::vector<char> kept = kept_nodes(overlay, borders);
  std::vector<Index> node_of(overlay.nodes.size(), kNone);
  std::vector<Index> dart_of(from.dart_count(), kNone);  // first overlay dart -> own dart
  std::vector<Index> last_of;                            // own dart -> last overlay dart
  for (Index d = 0; d < from.dart_count(); ++d) {
    if (from.is_alive(d) && kept[from.from(d)] != 0 && dart_of[d] == kNone) {
      add_chain(overlay, borders, d, dart_of, kept, node_of);
    }
  }
  for (Index d = 0; d < from.dart_count(); ++d) {
    if (dart_of[d] == kNone) continue;
    Index last = d;
    while (kept[from.to(last)] == 0) last = from.next(last);
    graph_.link(dart_of[d], dart_of[from.next(last)]);
  }
  rank_.assign(nodes_.size(), NodeRank::line);
  is_kept_.assign(nodes_.size(), 0);
  for (Index d = 0; d < graph_.dart_count(); ++d) {
    const Index n = graph_.from(d);
    if (!is_barrier(d)) continue;
    const Index v = nodes_[n].vertex;
    rank_[n] = v != kNone && borders.is_corner[v] != 0 ? NodeRank::corner : NodeRank::barrier;
  }
}

void PolygonGraph::add_chain(const Overlay& overlay, const BorderCourse& borders, Index first,
                             std::vector<Index>& dart_of, const std::vector<char>& kept,
                             std::vector<Index>& node_of) {
  const DartGraph& from = overlay.graph;
  const auto own_node = [&](Index n) {
    if (node_of[n] == kNone) {
      node_of[n] = static_cast<Index>(nodes_.size());
      nodes_.push_back(placed(*mesh_, borders, overlay.nodes[n]));
    }
    return node_of[n];
  };
  std::vector<SurfaceNode> inner;
  Index last = first;
  while (kept[from.to(last)] == 0) {
    inner.push_back(placed(*mesh_, borders, overlay.nodes[from.to(last)]));
    last = from.next(last);
  }
  const Index own_from = own_node(from.from(first));
  const Index own_to = own_node(from.to(last));
  const Index dart = graph_.add_edge(own_from, own_to);
  dart_of[first] = dart;
  dart_of[DartGraph::opposite(last)] = DartGraph::opposite(dart);
  const Index e = DartGraph::edge_of(first);
  const bool boundary = overlay.kind[e] == EdgeKind::boundary;
  kind_.push_back(overlay.kind[e]);
  line_.push_back(overlay.line[e]);
  course_.push_back(std::move(inner));
  // The far side of a boundary edge is the odd dart of every fragment.
  outer_.push_back(boundary && first % 2 == 1 ? 1 : 0);
  outer_.push_back(boundary && first % 2 == 0 ? 1 : 0);
}

bool PolygonGraph::is_hole(Index dart) const {
  Index d = dart;
  do {
    if (outer_[d] != 0) return true;
    d = graph_.next(d);
  } while (d != dart);
  return false;
}

Index PolygonGraph::degree(Index dart) const {
  Index count = 0;
  Index d = dart;
  do {
    ++count;
    d = graph_.rotate_ccw(d);
  } while (d != dart);
  return count;
}

DartLoop PolygonGraph::cell(Index dart) const {
  DartLoop darts;
  Index d = dart;
  do {
    darts.push_back(d);
    d = graph_.next(d);
  } while (d != dart);
  return darts;
}

Index PolygonGraph::name_of_cell(Index dart) const {
  Index least = dart;
  for (Index d = graph_.next(dart); d != dart; d = graph_.next(d)) least = std::min(least, d);
  return least;
}

Index PolygonGraph::find_edge(Index around, Index b) const {
  Index d = around;
  do {
    if (graph_.to(d) == b) return d;
    d = graph_.rotate_ccw(d);
  } while (d != around);
  return kNone;
}

std::vector<Vec3> PolygonGraph::course(Index dart) const {
  std::vector<Vec3> points;
  const auto& inner = course_[DartGraph::edge_of(dart)];
  points.push_back(position(graph_.from(dart & ~1)));
  for (const SurfaceNode& n : inner) points.push_back(n.position);
  points.push_back(position(graph_.to(dart & ~1)));
  if (dart % 2 == 1) std::reverse(points.begin(), points.end());
  return points;
}

double PolygonGraph::length(Index dart) const {
  const std::vector<Vec3> points = course(dart);
  double sum = 0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

PolygonGraph::Bend PolygonGraph::bend(Index dart) const {
  const std::vector<Vec3> course = this->course(dart);
  const Vec3 along = course.back() - course.front();
  const double squared = along.squaredNorm();
  Bend bend;
  double way = 0;
  for (std::size_t i = 1; i + 1 < course.size() && squared > 0; ++i) {
    way += (course[i] - course[i - 1]).norm();
    const Vec3 offset = course[i] - course.front();
    const double distance = (offset - along * (offset.dot(along) / squared)).norm();
    if (distance > bend.distance) bend = {distance, way};
  }
  bend.share /= length(dart);
  return bend;
}

void PolygonGraph::describe_plain_edge() {
  kind_.push_back(EdgeKind::line);
  line_.push_back(kNone);
  outer_.resize(outer_.size() + 2, 0);
  course_.emplace_back();
}

Index PolygonGraph::connect(Index a, Index b) {
  describe_plain_edge();
  return graph_.connect(a, b);
}

std::vector<Index> PolygonGraph::refill(const std::vector<std::vector<Index>>& outlines,
                                        const std::vector<Index>& inside,
                                        const std::vector<std::array<Index, 3>>& triangles) {
  if (!fit_together(graph_, outlines, triangles)) return {};
  std::map<Side, Index> dart_along;
  std::map<Index, Index> dart_at;
  for (const std::vector<Index>& outline : outlines) {
    for (const Index d : outline) {
      dart_along[{graph_.from(d), graph_.to(d)}] = d;
      dart_at[graph_.from(d)] = d;
    }
  }
  std::vector<Side> added;
  for (const auto& triangle : triangles) {
    for (const auto& [from, to] : sides(triangle)) {
      if (from < to && !dart_along.contains({from, to})) added.emplace_back(from, to);
    }
  }
  std::set<Index> removed;
  for (const Index d : inside) removed.insert({d, DartGraph::opposite(d)});
  for (const auto& [from, to] : added) {
    const Index first = dart_at.at(from);
    Index d = first;
    do {
      if (graph_.to(d) == to && !removed.contains(d)) return {};
      d = graph_.rotate_ccw(d);
    } while (d != first);
  }
  // As many cells more than edges as before, nodes that go counted as cells: else parts of the
  // surface would come apart, or grow together.
  std::set<Index> cells;
  std::set<Index> gone;
  for (const Index d : removed) {
    cells.insert(name_of_cell(d));
    if (!dart_at.contains(graph_.from(d))) gone.insert(graph_.from(d));
  }
  if (cells.size() + gone.size() + added.size() != triangles.size() + inside.size()) return {};
  graph_.drop_edges(inside);
  for (const auto& [from, to] : added) {
    const Index dart = graph_.add_edge(from, to);
    describe_plain_edge();
    dart_along[{from, to}] = dart;
    dart_along[{to, from}] = DartGraph::opposite(dart);
  }
  std::vector<Index> made;
  for (const auto& triangle : triangles) {
    std::array<Index, 3> darts{};
    for (int i = 0; i < 3; ++i) darts[i] = dart_along.at(sides(triangle)[i]);
    for (int i = 0; i < 3; ++i) graph_.link(darts[i], darts[(i + 1) % 3]);
    made.push_back(darts[0]);
  }
  return made;
}

/// Appends the course of `dart` to that of `first`, which ends where `dart` starts.
void PolygonGraph::extend_course(Index first, Index dart) {
  std::vector<SurfaceNode>& joined = course_[DartGraph::edge_of(first)];
  if (first % 2 == 1) std::reverse(joined.begin(), joined.end());
  joined.push_back(nodes_[graph_.from(dart)]);
  std::vector<SurfaceNode> rest = std::move(course_[DartGraph::edge_of(dart)]);
  if (dart % 2 == 1) std::reverse(rest.begin(), rest.end());
  joined.insert(joined.end(), rest.begin(), rest.end());
  if (first % 2 == 1) std::reverse(joined.begin(), joined.end());
  course_[DartGraph::edge_of(dart)].clear();
}

void PolygonGraph::dissolve(Index dart) {
  extend_course(graph_.prev(dart), dart);
  graph_.dissolve_node(dart);
}

Vec3 PolygonGraph::surface_normal(Index n) const {
  return face_cross(*mesh_, nodes_[n].at.face).stableNormalized();
}

void PolygonGraph::hold(Index dart) {
  kind_[DartGraph::edge_of(dart)] = EdgeKind::feature;
  for (const Index d : {dart, DartGraph::opposite(dart)}) rank_[graph_.from(d)] = NodeRank::corner;
}

void PolygonGraph::contract(Index dart) {
  if (is_barrier(dart) && rank_[graph_.from(dart)] == NodeRank::barrier) {
    for (Index d = graph_.rotate_ccw(dart); d != dart; d = graph_.rotate_ccw(d)) {
      if (!is_barrier(d)) continue;
      extend_course(DartGraph::opposite(d), dart);
      break;
    }
  }
  graph_.contract(dart);
}

SurfaceNode PolygonGraph::between(const SurfaceNode& a, const SurfaceNode& b, double share) const {
  SurfaceNode node;
  node.position = a.position + share * (b.position - a.position);
  node.offset = a.offset + share * (b.offset - a.offset);
  const Vec3 on_surface = node.position - node.offset;
  // Neighbouring points of a course share a face: one of theirs, or a neighbour of it.
  double best = std::numeric_limits<double>::infinity();
  const auto consider = [&](Index f) {
    const FaceChart chart = lay_out(*mesh_, f);
    const Vec3& origin = mesh_->positions[mesh_->faces[f][0]];
    const Vec3 x = (mesh_->positions[mesh_->faces[f][1]] - origin).normalized();
    const Vec3 side = mesh_->positions[mesh_->faces[f][2]] - origin;
    const Vec3 y = (side - x * x.dot(side)).normalized();
    const Vec3 offset = on_surface - origin;
    Vec3 bary = chart.barycentric(Vec2(x.dot(offset), y.dot(offset))).cwiseMax(0.0);
    bary /= bary.sum();
    const SurfacePoint foot{f, {bary[0], bary[1], bary[2]}};
    const double distance = (place_of(*mesh_, foot) - on_surface).squaredNorm();
    if (!(distance < best)) return;
    best = distance;
    node.at = foot;
  };
  for (const Index f : {a.at.face, b.at.face}) {
    consider(f);
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      if (mesh_->twin[h] != kNone) consider(TriMesh::face_of(mesh_->twin[h]));
    }
  }
  if (node.at.face == kNone) node.at = a.at;
  return node;
}

/// A point of the course of an edge, both ends included.
const SurfaceNode& PolygonGraph::point(Index even, std::size_t i) const {
  const std::vector<SurfaceNode>& inner = course_[DartGraph::edge_of(even)];
  if (i == 0) return nodes_[graph_.from(even)];
  return i <= inner.size() ? inner[i - 1] : nodes_[graph_.to(even)];
}

PolygonGraph::Cut PolygonGraph::cut(Index dart, double share) const {
  const Index even = dart & ~1;
  const std::size_t last = course_[DartGraph::edge_of(dart)].size() + 1;
  const auto piece = [&](std::size_t i) {
    return (point(even, i).position - point(even, i - 1).position).norm();
  };
  double length = 0;
  for (std::size_t i = 1; i <= last; ++i) length += piece(i);
  const double wanted = (dart == even ? share : 1 - share) * length;
  double before = 0;  // length up to the piece that holds the place
  double after = piece(1);
  std::size_t at = 1;
  while (at < last && after < wanted) {
    before = after;
    after += piece(++at);
  }
  const double span = after - before;
  const double local = span > 0 ? std::clamp((wanted - before) / span, 0.0, 1.0) : 0.5;
  constexpr double kSnap = 0.3;  // to a point that exists, so that corners of the course are kept
  if (local > 1 - kSnap && at < last) return {at, at + 1, 0};
  if (local < kSnap && at > 1) return {at - 1, at, 0};
  return {at, at, std::clamp(local, 0.1, 0.9)};
}

Vec3 PolygonGraph::split_position(Index dart, double share) const {
  const Index even = dart & ~1;
  const Cut cut = this->cut(dart, share);
  const Vec3& at = point(even, cut.stop).position;
  if (cut.is_point()) return at;
  const Vec3& before = point(even, cut.stop - 1).position;
  return before + cut.local * (at - before);
}

Index PolygonGraph::split(Index dart, double share) {
  const Index edge = DartGraph::edge_of(dart);
  const Index even = 2 * edge;
  const Cut cut = this->cut(dart, share);
  const auto node = static_cast<Index>(nodes_.size());
  SurfaceNode made = cut.is_point()
                         ? point(even, cut.stop)
                         : between(point(even, cut.stop - 1), point(even, cut.stop), cut.local);
  made.vertex = kNone;
  nodes_.push_back(made);
  rank_.push_back(is_barrier(even) ? NodeRank::barrier : NodeRank::line);
  is_kept_.push_back(0);
  const Index second = graph_.split_edge(even, node);
  kind_.push_back(kind_[edge]);
  line_.push_back(line_[edge]);
  outer_.push_back(outer_[even]);
  outer_.push_back(outer_[even + 1]);
  // Inner points count from one.
  const auto at = [&](std::size_t i) {
    return course_[edge].begin() + static_cast<std::ptrdiff_t>(i) - 1;
  };
  std::vector<SurfaceNode> rest(at(cut.resume), course_[edge].end());
  course_[edge].erase(at(cut.stop), course_[edge].end());
  course_.push_back(std::move(rest));
  return dart == even ? second : DartGraph::opposite(even);
}

}  // namespace strake
