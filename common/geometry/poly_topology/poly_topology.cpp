#include "common/geometry/poly_topology/poly_topology.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "common/core/disjoint_sets.h"
#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

void note(ElementDefect& defect, Index element) {
  if (defect.count++ == 0) defect.first = element;
}

void note(EdgeDefect& defect, const PolyEdges& edges, Index edge) {
  if (defect.count++ != 0) return;
  defect.vertices = edges.vertices[edge];
  defect.face = edges.corner_face[edges.sides_of(edge).back()];
}

/// One examination of a mesh; each step fills in a part of the result.
class Analysis {
 public:
  Analysis(const PolyMesh& mesh, const PolyEdges& edges)
      : mesh_(mesh), edges_(edges), fans_(static_cast<Index>(mesh.corners.size())) {}

  PolyTopology run() {
    census_faces();
    census_edges();
    census_vertices();
    count_components();
    count_boundary_loops();
    if (result_.misoriented_edges.count > 0) result_.is_orientable = can_be_oriented();
    result_.euler = std::int64_t{result_.used_vertices} - result_.edges + result_.faces;
    if (result_.is_oriented_manifold()) {
      result_.genus =
          (2 * std::int64_t{result_.components} - result_.boundary_loops - result_.euler) / 2;
    }
    return result_;
  }

 private:
  void census_faces() {
    result_.faces = mesh_.face_count();
    std::vector<Index> last_face(mesh_.positions.size(), kNone);  // that named each vertex
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      const std::span<const Index> face = mesh_.face(f);
      const auto sides = static_cast<Index>(face.size());
      result_.most_sides = std::max(result_.most_sides, sides);
      if (sides < 3) note(result_.small_faces, f);
      if (sides == 3) ++result_.triangles;
      if (sides == 4) ++result_.quads;
      if (sides == 5) ++result_.pentagons;
      if (sides > 5) ++result_.larger_faces;
      bool repeats = false;
      for (const Index v : face) {
        repeats |= last_face[v] == f;
        last_face[v] = f;
      }
      if (repeats) note(result_.repeated_corners, f);
    }
    result_.unused_vertices =
        static_cast<Index>(std::count(last_face.begin(), last_face.end(), kNone));
    result_.used_vertices = mesh_.vertex_count() - result_.unused_vertices;
  }

  /// Whether the side that starts at this corner runs from the edge's smaller vertex.
  [[nodiscard]] bool is_forward(Index side) const {
    return mesh_.corners[side] < mesh_.corners[next_corner(mesh_, edges_, side)];
  }

  void census_edges() {
    result_.edges = edges_.edge_count();
    on_bad_edge_.assign(mesh_.positions.size(), 0);
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const Index> sides = edges_.sides_of(e);
      if (sides.size() == 1) {
        ++result_.boundary_edges;
      } else if (sides.size() == 2) {
        const bool same_way = is_forward(sides[0]) == is_forward(sides[1]);
        if (same_way) note(result_.misoriented_edges, edges_, e);
        const Index after0 = next_corner(mesh_, edges_, sides[0]);
        const Index after1 = next_corner(mesh_, edges_, sides[1]);
        fans_.unite(sides[0], same_way ? sides[1] : after1);
        fans_.unite(after0, same_way ? after1 : sides[1]);
      } else {
        note(result_.nonmanifold_edges, edges_, e);
        for (const Index v : edges_.vertices[e]) on_bad_edge_[v] = 1;
      }
    }
  }

  void census_vertices() {
    std::vector<Index> fan_of(mesh_.positions.size(), kNone);
    std::vector<std::uint8_t> is_bad = on_bad_edge_;
    for (Index c = 0; c < static_cast<Index>(mesh_.corners.size()); ++c) {
      const Index fan = fans_.find(c);
      Index& known = fan_of[mesh_.corners[c]];
      if (known != kNone && known != fan) is_bad[mesh_.corners[c]] = 1;
      known = fan;
    }
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (is_bad[v] != 0) note(result_.nonmanifold_vertices, v);
    }
  }

  void count_components() {
    DisjointSets sets(mesh_.face_count());
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const Index> sides = edges_.sides_of(e);
      for (const Index side : sides.subspan(1)) {
        sets.unite(edges_.corner_face[sides[0]], edges_.corner_face[side]);
      }
    }
    for (Index f = 0; f < mesh_.face_count(); ++f) result_.components += sets.find(f) == f ? 1 : 0;
  }

  void count_boundary_loops() {
    DisjointSets loops(edges_.edge_count());
    std::vector<Index> edge_at_fan(mesh_.corners.size(), kNone);
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const Index> sides = edges_.sides_of(e);
      if (sides.size() != 1) continue;
      for (const Index corner : {sides[0], next_corner(mesh_, edges_, sides[0])}) {
        Index& known = edge_at_fan[fans_.find(corner)];
        if (known == kNone) {
          known = e;
        } else {
          loops.unite(known, e);
        }
      }
    }
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      if (edges_.sides_of(e).size() == 1 && loops.find(e) == e) ++result_.boundary_loops;
    }
  }

  /// Two copies of every face, one turned over: a component can be oriented unless they connect.
  [[nodiscard]] bool can_be_oriented() const {
    DisjointSets sets(2 * mesh_.face_count());
    for (Index e = 0; e < edges_.edge_count(); ++e) {
      const std::span<const Index> sides = edges_.sides_of(e);
      if (sides.size() != 2) continue;
      const Index f = edges_.corner_face[sides[0]];
      const Index g = edges_.corner_face[sides[1]];
      const Index turned = is_forward(sides[0]) == is_forward(sides[1]) ? 1 : 0;
      sets.unite(2 * f, 2 * g + turned);
      sets.unite(2 * f + 1, 2 * g + 1 - turned);
    }
    for (Index f = 0; f < mesh_.face_count(); ++f) {
      if (sets.find(2 * f) == sets.find(2 * f + 1)) return false;
    }
    return true;
  }

  const PolyMesh& mesh_;
  const PolyEdges& edges_;
  DisjointSets fans_;  // corners of one vertex, joined across edges with two faces
  std::vector<std::uint8_t> on_bad_edge_;
  PolyTopology result_;
};

void tell(std::string& text, const ElementDefect& defect, const char* what, const char* element) {
  if (defect.count == 0) return;
  text += (text.empty() ? "" : "; ") + std::to_string(defect.count) + " " + what +
          " (first: " + element + " " + std::to_string(defect.first) + ")";
}

void tell(std::string& text, const EdgeDefect& defect, const char* what) {
  if (defect.count == 0) return;
  text += (text.empty() ? "" : "; ") + std::to_string(defect.count) + " " + what +
          " (first: between vertices " + std::to_string(defect.vertices[0]) + " and " +
          std::to_string(defect.vertices[1]) + ", at face " + std::to_string(defect.face) + ")";
}

}  // namespace

bool PolyTopology::is_oriented_manifold() const {
  return nonmanifold_edges.count == 0 && misoriented_edges.count == 0 &&
         nonmanifold_vertices.count == 0 && repeated_corners.count == 0 && small_faces.count == 0;
}

std::string PolyTopology::defects() const {
  std::string text;
  tell(text, nonmanifold_edges, "edges with more than two faces");
  tell(text, misoriented_edges, "edges whose faces run the same way");
  tell(text, nonmanifold_vertices, "vertices with several fans of faces", "vertex");
  tell(text, repeated_corners, "faces that name a vertex twice", "face");
  tell(text, small_faces, "faces with fewer than three corners", "face");
  return text;
}

PolyTopology analyse(const PolyMesh& mesh) { return analyse(mesh, collect_edges(mesh)); }

PolyTopology analyse(const PolyMesh& mesh, const PolyEdges& edges) {
  return Analysis(mesh, edges).run();
}

ClosedComponents judge_closed_components(const PolyMesh& mesh) {
  const PolyEdges edges = collect_edges(mesh);
  DisjointSets sets(mesh.face_count());
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const std::span<const Index> sides = edges.sides_of(e);
    for (const Index side : sides) {
      sets.unite(edges.corner_face[sides[0]], edges.corner_face[side]);
    }
  }
  // Numbered by their first face; other numbers are those of no component.
  std::vector<std::uint8_t> is_closed(mesh.offsets.size() - 1, 0);
  for (Index f = 0; f < mesh.face_count(); ++f) is_closed[sets.find(f)] = 1;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const std::span<const Index> sides = edges.sides_of(e);
    const auto is_forward = [&](Index side) { return mesh.corners[side] == edges.vertices[e][0]; };
    if (sides.size() != 2 || is_forward(sides[0]) == is_forward(sides[1])) {
      is_closed[sets.find(edges.corner_face[sides[0]])] = 0;
    }
  }
  const FaceTriangles triangles = triangulate_faces(mesh);
  std::vector<Index> component;
  for (const Index f : triangles.face) component.push_back(sets.find(f));
  return judge_closed_components(mesh.positions, triangles.corners, component, is_closed);
}

}  // namespace strake
