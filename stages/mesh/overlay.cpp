#include "stages/mesh/overlay.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>

#include "common/core/disjoint_sets.h"
#include "common/core/error.h"
#include "common/geometry/line_chord.h"
#include "stages/mesh/face_arrangement.h"

namespace strake {
namespace {

struct EdgePoint {
  Index edge;     ///< canonical half-edge
  double lambda;  ///< along it
  Index point;    ///< of the LineSet
};

void check_lines(const TriMesh& mesh, const LineSet& lines) {
  for (Index l = 0; l < lines.line_count(); ++l) {
    const Index first = lines.offsets[l];
    const Index last = lines.offsets[l + 1];
    for (Index p = first; p < last; ++p) {
      const Index face = lines.chord_face[p];
      if (face == kNone) continue;
      const Index q = p + 1 < last ? p + 1 : first;
      if (!is_proper_chord(mesh, face, lines.points[p], lines.points[q])) {
        throw PreconditionError("line " + std::to_string(l) + ", point " +
                                std::to_string(p - first) +
                                ": its chord does not join two sides of face " +
                                std::to_string(face) + "; trace the lines again for this mesh");
      }
    }
  }
}

std::vector<EdgePoint> sorted_edge_points(const TriMesh& mesh, const LineSet& lines) {
  std::vector<EdgePoint> points;
  for (Index p = 0; p < static_cast<Index>(lines.points.size()); ++p) {
    const LinePoint& point = lines.points[p];
    if (is_vertex_point(point)) continue;
    const Index edge = mesh.edge_of(point.halfedge);
    points.push_back({edge, edge == point.halfedge ? point.lambda : 1 - point.lambda, p});
  }
  std::sort(points.begin(), points.end(), [](const EdgePoint& a, const EdgePoint& b) {
    return std::tie(a.edge, a.lambda, a.point) < std::tie(b.edge, b.lambda, b.point);
  });
  return points;
}

/// Builds the overlay's nodes and edges along the triangle edges and links them into faces.
class EdgeCutter {
 public:
  EdgeCutter(const TriMesh& mesh, const LineSet& lines, Overlay& overlay)
      : mesh_(mesh), overlay_(overlay) {
    point_node_.assign(lines.points.size(), kNone);
    const std::vector<EdgePoint> points = sorted_edge_points(mesh, lines);
    add_nodes(lines, points);
    add_fragments(points);
    mark_feature_lines(lines);
    link_faces();
    link_boundary();
  }

  [[nodiscard]] const std::vector<Index>& point_nodes() const { return point_node_; }
  /// The first dart along half-edge h, on the side of its face.
  [[nodiscard]] Index first_dart(Index h) const {
    const Index e = mesh_.edge_of(h);
    return e == h ? 2 * first_[e] : 2 * (first_[e] + count_[e] - 1) + 1;
  }

 private:
  void add_nodes(const LineSet& lines, const std::vector<EdgePoint>& points) {
    for (std::size_t i = 0; i < lines.points.size(); ++i) {
      if (is_vertex_point(lines.points[i])) point_node_[i] = mesh_.from(lines.points[i].halfedge);
    }
    for (const EdgePoint& point : points) {
      point_node_[point.point] = overlay_.nodes.add_edge_point({point.edge, point.lambda});
    }
  }

  void add_fragments(const std::vector<EdgePoint>& points) {
    first_.assign(mesh_.halfedge_count(), kNone);
    count_.assign(mesh_.halfedge_count(), 0);
    reserve_edges(points.size());
    std::size_t at = 0;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (mesh_.edge_of(h) != h) continue;
      const EdgeKind kind = mesh_.is_boundary(h) ? EdgeKind::boundary : EdgeKind::surface;
      first_[h] = overlay_.graph.dart_count() / 2;
      Index from = mesh_.from(h);
      for (; at < points.size() && points[at].edge == h; ++at) {
        const Index node = point_node_[points[at].point];
        overlay_.graph.add_edge(from, node);
        from = node;
      }
      overlay_.graph.add_edge(from, mesh_.to(h));
      count_[h] = overlay_.graph.dart_count() / 2 - first_[h];
      overlay_.kind.resize(overlay_.graph.dart_count() / 2, kind);
    }
    overlay_.line.resize(overlay_.kind.size(), kNone);
  }

  /// Each point divides an edge and begins a chord, which crossings divide further; what is not
  /// used of the room for those costs nothing, and vectors that grow have twice their size for a
  /// while.
  void reserve_edges(std::size_t points) {
    std::size_t edges = 3 * points;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) edges += mesh_.edge_of(h) == h ? 1 : 0;
    if (edges > std::numeric_limits<Index>::max() / 2) {
      throw InputError(fmt::format(
          "{} edges, cut by lines, are more than can be numbered; split the model into parts",
          edges));
    }
    overlay_.graph.reserve(2 * edges);
    overlay_.kind.reserve(edges);
    overlay_.line.reserve(edges);
  }

  void mark_feature_lines(const LineSet& lines) {
    for (Index l = 0; l < lines.line_count(); ++l) {
      if (lines.family[l] != LineFamily::boundary && lines.family[l] != LineFamily::feature)
        continue;
      for (Index p = lines.offsets[l]; p < lines.offsets[l + 1]; ++p) {
        if (lines.chord_face[p] != kNone) continue;
        const Index e = mesh_.edge_of(lines.points[p].halfedge);
        for (Index k = first_[e]; k < first_[e] + count_[e]; ++k) {
          overlay_.line[k] = l;
          if (overlay_.kind[k] == EdgeKind::surface) overlay_.kind[k] = EdgeKind::feature;
        }
      }
    }
  }

  void link_faces() {
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      Index last = last_dart(3 * f + 2);
      for (Index h = 3 * f; h < 3 * f + 3; ++h) {
        overlay_.graph.link(last, first_dart(h));
        last = link_along(h);
      }
    }
  }

  /// Links the fragments along half-edge h; returns the last.
  Index link_along(Index h) {
    const Index e = mesh_.edge_of(h);
    const Index step = e == h ? 2 : -2;
    Index dart = first_dart(h);
    for (Index k = 1; k < count_[e]; ++k, dart += step) overlay_.graph.link(dart, dart + step);
    return dart;
  }

  [[nodiscard]] Index last_dart(Index h) const {
    const Index e = mesh_.edge_of(h);
    return e == h ? 2 * (first_[e] + count_[e] - 1) : 2 * first_[e] + 1;
  }

  /// Links the outer sides of boundary edges around each hole.
  void link_boundary() {
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (!mesh_.is_boundary(h)) continue;
      // Outer darts run against h; the one along the boundary edge before h comes next.
      Index out = h;
      while (mesh_.rotate_ccw(out) != kNone) out = mesh_.rotate_ccw(out);
      const Index before = TriMesh::prev(out);
      for (Index k = count_[h] - 1; k > 0; --k) {
        overlay_.graph.link(2 * (first_[h] + k) + 1, 2 * (first_[h] + k - 1) + 1);
      }
      overlay_.graph.link(2 * first_[h] + 1, 2 * (first_[before] + count_[before] - 1) + 1);
    }
  }

  const TriMesh& mesh_;
  Overlay& overlay_;
  std::vector<Index> point_node_;  ///< [P] node of each point of the LineSet
  std::vector<Index> first_;       ///< [3F] first edge along a canonical half-edge
  std::vector<Index> count_;       ///< [3F] edges along it
};

/// Removes surface edges in the order of a walk over cells, so that the cut lines that must stay
/// are where two fronts meet.
void merge_cells(Overlay& overlay) {
  DartGraph& graph = overlay.graph;
  std::vector<Index> cell(graph.dart_count(), kNone);
  std::vector<Index> first_dart;
  for (Index d = 0; d < graph.dart_count(); ++d) {
    if (cell[d] != kNone) continue;
    const auto id = static_cast<Index>(first_dart.size());
    first_dart.push_back(d);
    Index at = d;
    do {
      cell[at] = id;
      at = graph.next(at);
    } while (at != d);
  }
  // Collected first, removed afterwards: the walk needs the cells' original outlines.
  DisjointSets sets(static_cast<Index>(first_dart.size()));
  std::vector<Index> removable;
  std::vector<char> seen(first_dart.size(), 0);
  std::vector<Index> queue;
  for (Index start = 0; start < static_cast<Index>(first_dart.size()); ++start) {
    if (seen[start] != 0) continue;
    seen[start] = 1;
    queue.assign(1, start);
    for (std::size_t at = 0; at < queue.size(); ++at) {
      Index d = first_dart[queue[at]];
      do {
        const Index other = cell[DartGraph::opposite(d)];
        if (overlay.kind[DartGraph::edge_of(d)] == EdgeKind::surface &&
            sets.unite(cell[d], other)) {
          removable.push_back(d);
          if (seen[other] == 0) {
            seen[other] = 1;
            queue.push_back(other);
          }
        }
        d = graph.next(d);
      } while (d != first_dart[queue[at]]);
    }
  }
  for (const Index d : removable) graph.remove_edge(d);
}

/// Removes edges that end in nodes of degree one, again and again ([MK04] section 5), but features.
void prune(Overlay& overlay) {
  overlay.graph.take_back_free_ends([&overlay](Index d) {
    if (overlay.kind[DartGraph::edge_of(d)] == EdgeKind::feature) return false;
    overlay.graph.remove_edge(d);
    return true;
  });
}

}  // namespace

SurfaceNode OverlayNodes::operator[](Index n) const {
  if (n >= first_crossing()) return crossings_[n - first_crossing()];
  SurfaceNode node;
  if (n < mesh_->vertex_count()) {
    node.position = mesh_->positions[n];
    node.at = point_at_vertex(*mesh_, n);
    node.vertex = n;
  } else {
    const LinePoint& point = edge_points_[n - mesh_->vertex_count()];
    node.position = line_point_position(*mesh_, point);
    node.at = point_along(point.halfedge, point.lambda);
  }
  return node;
}

Index OverlayNodes::add_edge_point(const LinePoint& point) {
  edge_points_.push_back(point);
  return size() - 1;
}

Index OverlayNodes::add_crossing(Index face, const Vec3& barycentric) {
  SurfaceNode node;
  node.at = {face, {barycentric[0], barycentric[1], barycentric[2]}};
  node.position = place_of(*mesh_, node.at);
  crossings_.push_back(node);
  return size() - 1;
}

Overlay build_overlay(const TriMesh& mesh, const LineSet& lines, Observer& observer) {
  check_lines(mesh, lines);
  Overlay overlay(mesh);
  const EdgeCutter cutter(mesh, lines, overlay);
  observer.report("cutting faces", 0);

  struct FaceChord {
    Index face;
    FaceArrangement::Chord chord;
  };
  std::vector<FaceChord> chords;
  for (Index l = 0; l < lines.line_count(); ++l) {
    for (Index p = lines.offsets[l]; p < lines.offsets[l + 1]; ++p) {
      if (lines.chord_face[p] == kNone) continue;
      const Index q = p + 1 < lines.offsets[l + 1] ? p + 1 : lines.offsets[l];
      chords.push_back(
          {lines.chord_face[p], {cutter.point_nodes()[p], cutter.point_nodes()[q], l}});
    }
  }
  std::stable_sort(chords.begin(), chords.end(),
                   [](const FaceChord& a, const FaceChord& b) { return a.face < b.face; });
  FaceArrangement arrangement(mesh, overlay);
  std::vector<FaceArrangement::Chord> of_face;
  for (std::size_t at = 0; at < chords.size();) {
    const Index face = chords[at].face;
    of_face.clear();
    for (; at < chords.size() && chords[at].face == face; ++at) of_face.push_back(chords[at].chord);
    arrangement.insert(face, cutter.first_dart(3 * face), of_face);
  }
  return overlay;
}

Index reduce_to_lines(Overlay& overlay) {
  merge_cells(overlay);
  prune(overlay);
  Index cuts = 0;
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    cuts += overlay.graph.is_alive(2 * e) && overlay.kind[e] == EdgeKind::surface;
  }
  return cuts;
}

}  // namespace strake
