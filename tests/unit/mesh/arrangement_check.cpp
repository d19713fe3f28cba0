#include "tests/unit/mesh/arrangement_check.h"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>
#include <vector>

#include "common/geometry/line_chord.h"
#include "tests/unit/mesh/graphs.h"

namespace strake {
namespace {

/// Two chords of one face that cross: the face and the lines, smaller first.
using Crossing = std::tuple<Index, Index, Index>;

/// The place of each line's ends on a face's outline: corner or edge, and the order along it, with
/// equal places ordered by the point's number along the edge's canonical half-edge.
struct Place {
  int side;  ///< 2 i for corner i, 2 i + 1 for the edge after it
  double along;
  Index tie;
  bool operator<(const Place& o) const {
    return std::tie(side, along, tie) < std::tie(o.side, o.along, o.tie);
  }
};

Place place_on(const TriMesh& mesh, Index face, const LineSet& lines, Index p) {
  const LinePoint& point = lines.points[p];
  if (is_vertex_point(point)) {
    for (int i = 0; i < 3; ++i) {
      if (mesh.faces[face][i] == mesh.from(point.halfedge)) return {2 * i, 0, 0};
    }
  }
  const Index edge = mesh.edge_of(point.halfedge);
  const double lambda = edge == point.halfedge ? point.lambda : 1 - point.lambda;
  if (TriMesh::face_of(edge) == face) return {2 * (edge % 3) + 1, lambda, p};
  return {2 * (mesh.twin[edge] % 3) + 1, -lambda, -p};
}

std::set<Crossing> expected_crossings(const TriMesh& mesh, const LineSet& lines) {
  struct Chord {
    Index line;
    Place low, high;
  };
  std::map<Index, std::vector<Chord>> chords;
  for (Index l = 0; l < lines.line_count(); ++l) {
    for (Index p = lines.offsets[l]; p + 1 < lines.offsets[l + 1]; ++p) {
      const Index face = lines.chord_face[p];
      const Place a = place_on(mesh, face, lines, p);
      const Place b = place_on(mesh, face, lines, p + 1);
      chords[face].push_back({l, std::min(a, b), std::max(a, b)});
    }
  }
  std::set<Crossing> crossings;
  for (const auto& [face, list] : chords) {
    for (const Chord& a : list) {
      for (const Chord& b : list) {
        if (a.low < b.low && b.low < a.high && a.high < b.high) {
          crossings.emplace(face, std::min(a.line, b.line), std::max(a.line, b.line));
        }
      }
    }
  }
  return crossings;
}

}  // namespace

std::string arrangement_fault(const TriMesh& mesh, const LineSet& lines, const Overlay& overlay) {
  const DartGraph& graph = overlay.graph;
  if (!is_consistent(graph)) return "darts do not fit together";
  const GraphCounts counts = count(graph);
  if (counts.parts != 1) return "it falls into parts";
  if (counts.euler() != 2) return "not every cell is a disk";

  const std::set<Crossing> expected = expected_crossings(mesh, lines);
  Index edge_points = 0;
  for (const LinePoint& p : lines.points) edge_points += is_vertex_point(p) ? 0 : 1;
  const Index first_crossing = mesh.vertex_count() + edge_points;
  const auto crossings = overlay.nodes.size() - first_crossing;
  if (crossings != static_cast<Index>(expected.size())) {
    return std::to_string(crossings) + " crossings instead of " + std::to_string(expected.size());
  }
  std::set<Crossing> found;
  for (Index d = 0; d < graph.dart_count(); ++d) {
    const Index node = graph.from(d);
    if (node < first_crossing) continue;
    const std::vector<Index> around = darts_around(graph, d);
    if (around.size() != 4) return "a crossing has not four edges";
    const auto line = [&](int i) { return overlay.line[DartGraph::edge_of(around[i])]; };
    if (line(0) != line(2) || line(1) != line(3) || line(0) == line(1)) {
      return "chords do not go straight through their crossing";
    }
    found.emplace(overlay.nodes[node].at.face, std::min(line(0), line(1)),
                  std::max(line(0), line(1)));
  }
  return found == expected ? "" : "other chords cross than should";
}

}  // namespace strake
