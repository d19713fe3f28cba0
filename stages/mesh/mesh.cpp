#include "stages/mesh/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <string>

#include "common/core/error.h"
#include "common/geometry/border_course.h"
#include "common/geometry/carry_attributes.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/poly_topology/same_topology.h"
#include "common/geometry/topology/topology.h"
#include "stages/mesh/cell_shape.h"
#include "stages/mesh/edge_heights.h"
#include "stages/mesh/flats.h"
#include "stages/mesh/halfedge_check.h"
#include "stages/mesh/overlay.h"
#include "stages/mesh/pairing.h"
#include "stages/mesh/partition.h"
#include "stages/mesh/polygon_graph.h"
#include "stages/mesh/pure_quads.h"
#include "stages/mesh/regularise.h"
#include "stages/mesh/sharp_points.h"
#include "stages/mesh/simplify.h"
#include "stages/mesh/small_components.h"
#include "stages/mesh/strip_count.h"

namespace strake {
namespace {

/// Edges below this share of the local line distance are contracted.
constexpr double kShortestEdge = 0.3;
/// A component whose lines make fewer cells than a tetrahedron has keeps its triangles, and so does
/// one whose few cells enclose less than this share of its volume: they are folded, or inside out.
constexpr Index kFewestCells = 4;
constexpr Index kFewCells = 12;
constexpr double kLeastVolume = 0.05;

/// What becomes of the triangles of a component: where too few cells are left, the next.
enum class Triangles : std::uint8_t {
  merged,  ///< to cells between lines
  kept,    ///< as cells, which are simplified and joined to quads
  held,  ///< as simplified: joining them ended with two faces back to back. For pure quads each is
         ///< divided
};

bool are_all_merged(const std::vector<Triangles>& triangles) {
  return std::ranges::all_of(triangles, [](Triangles what) { return what == Triangles::merged; });
}

/// The wanted edge length where a node lies: the smaller of the two line distances.
double local_size(const TriMesh& mesh, const LineSet& lines, const SurfaceNode& node) {
  double size = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh.face_wedges[node.at.face][i];
    size +=
        node.at.barycentric[i] * std::min(lines.spacing_along_min[w], lines.spacing_along_max[w]);
  }
  return size;
}

/// The wanted length of an edge: the distance between the lines that cross it.
double wanted_length(const TriMesh& mesh, const LineSet& lines, const PolygonGraph& graph,
                     Index dart) {
  const SurfaceNode& node = graph.node(graph.graph().from(dart));
  double along_min = 0;
  double along_max = 0;
  for (int i = 0; i < 3; ++i) {
    const Index w = mesh.face_wedges[node.at.face][i];
    along_min += node.at.barycentric[i] * lines.spacing_along_min[w];
    along_max += node.at.barycentric[i] * lines.spacing_along_max[w];
  }
  const Index line = graph.line(dart);
  if (line != kNone && lines.family[line] == LineFamily::minimum) return along_min;
  if (line != kNone && lines.family[line] == LineFamily::maximum) return along_max;
  return std::sqrt(along_min * along_max);
}

/// Three times the volume, with its sign, of the cone from an apex over a polygon.
double cone_volume(const Vec3& apex, const Polygon& p) { return (p[0] - apex).dot(vector_area(p)); }

/// The least of that over all ways to cut the polygon into triangles around a corner, times `sign`:
/// bent faces may be cut along any of these.
double least_cone_volume(const Vec3& apex, const Polygon& p, double sign) {
  const Vec3 area = vector_area(p);
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3& corner : p) least = std::min(least, sign * (corner - apex).dot(area));
  return least;
}

/// Takes the next step for components that have too few cells to be a surface.
/// \return whether there were any
bool find_starved(const TriMesh& mesh, const std::vector<Index>& component,
                  const PolygonGraph& graph, std::vector<Triangles>& triangles) {
  const DartGraph& g = graph.graph();
  std::vector<Vec3> apex(triangles.size());  // near the component, for tiny ones far away
  std::vector<double> volume(triangles.size(), 0);
  for (Index f = 0; f < mesh.face_count(); ++f)
    apex[component[f]] = mesh.positions[mesh.faces[f][0]];
  for (Index f = 0; f < mesh.face_count(); ++f) {
    Polygon p;
    for (const Index v : mesh.faces[f]) p.push_back(mesh.positions[v]);
    volume[component[f]] += cone_volume(apex[component[f]], p);
  }
  std::vector<Index> cells(triangles.size(), 0);
  std::vector<double> enclosed(triangles.size(), 0);
  graph.for_each_cell([&](Index d, const DartLoop& cell) {
    if (cell.size() < 3) return;
    const Index c = component[graph.node(g.from(d)).at.face];
    ++cells[c];
    enclosed[c] +=
        least_cone_volume(apex[c], corner_positions(graph, cell), volume[c] < 0 ? -1 : 1);
  });
  std::vector<char> open(triangles.size(), 0);  // one cell is enough for a surface with boundary
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) open[component[TriMesh::face_of(h)]] = 1;
  }
  bool found = false;
  for (std::size_t c = 0; c < triangles.size(); ++c) {
    const bool is_empty =
        open[c] == 0 && cells[c] <= kFewCells && enclosed[c] < kLeastVolume * std::abs(volume[c]);
    const bool is_starved = cells[c] < (open[c] != 0 ? 1 : kFewestCells) || is_empty;
    if (triangles[c] == Triangles::held || !is_starved) continue;
    triangles[c] = triangles[c] == Triangles::merged ? Triangles::kept : Triangles::held;
    found = true;
  }
  return found;
}

/// Protects the triangle edges of some components from removal, instead of the lines there.
void keep_triangles(const std::vector<Index>& component, const std::vector<Triangles>& triangles,
                    Overlay& overlay) {
  if (are_all_merged(triangles)) return;
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    const Index face = overlay.nodes[overlay.graph.from(2 * e)].at.face;
    if (triangles[component[face]] == Triangles::merged) continue;
    if (overlay.kind[e] == EdgeKind::surface) {
      overlay.kind[e] = EdgeKind::line;
    } else if (overlay.kind[e] == EdgeKind::line) {
      overlay.kind[e] = EdgeKind::surface;
      overlay.line[e] = kNone;
    }
  }
}

/// [components] cells that lines would make of those that keep their triangles; infinite: of
/// others.
std::vector<double> wanted_cells(const TriMesh& mesh, const LineSet& lines,
                                 const std::vector<Index>& component,
                                 const std::vector<Triangles>& triangles) {
  std::vector<double> cells;
  for (const Triangles what : triangles) {
    cells.push_back(what == Triangles::merged ? std::numeric_limits<double>::infinity() : 0);
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3& p = mesh.positions[a];
    const double area = (mesh.positions[b] - p).cross(mesh.positions[c] - p).norm() / 2;
    for (const Index w : mesh.face_wedges[f]) {
      cells[component[f]] += area / 3 / (lines.spacing_along_min[w] * lines.spacing_along_max[w]);
    }
  }
  return cells;
}

/// Protects the edges of what is left of components from all that comes after simplifying.
void hold_triangles(const std::vector<Index>& component, const std::vector<Triangles>& triangles,
                    PolygonGraph& graph) {
  const DartGraph& g = graph.graph();
  for (Index d = 0; d < g.dart_count(); d += 2) {
    if (!g.is_alive(d) || graph.is_barrier(d)) continue;
    if (triangles[component[graph.node(g.from(d)).at.face]] == Triangles::held) graph.hold(d);
  }
}

QuadMesh assemble(const TriMesh& mesh, const PolygonGraph& graph) {
  QuadMesh result;
  result.mesh_id = mesh.id;
  std::vector<Index> vertex_of(graph.node_count(), kNone);
  const DartGraph& g = graph.graph();
  std::vector<Index> corners;
  graph.for_each_cell([&](Index, const DartLoop& cell) {
    corners.clear();
    for (const Index other : cell) {
      const Index n = g.from(other);
      if (vertex_of[n] == kNone) {
        vertex_of[n] = result.mesh.vertex_count();
        result.mesh.positions.push_back(graph.position(n) + mesh.origin);
        result.provenance.face.push_back(graph.node(n).at.face);
        result.provenance.barycentric.push_back(graph.node(n).at.barycentric);
        std::array<Index, 2> lines = {kNone, kNone};
        Index around = other;
        do {
          const Index line = graph.line(around);
          if (line != kNone && line != lines[0] && line != lines[1]) {
            (lines[0] == kNone ? lines[0] : lines[1]) = line;
          }
          around = g.rotate_ccw(around);
        } while (around != other && lines[1] == kNone);
        result.provenance.lines.push_back(lines);
      }
      corners.push_back(vertex_of[n]);
    }
    result.mesh.add_face(corners);
  });
  return result;
}

/// Holds the result to the surface it came from, and to what was wanted.
/// \throw AlgorithmError naming the difference
void check_result(const TriMesh& mesh, const PolyMesh& quads, Index max_sides, Report& report) {
  const PolyTopology after = analyse(quads);
  report.set("mesh.vertices", static_cast<std::int64_t>(quads.vertex_count()));
  report.set("mesh.faces", static_cast<std::int64_t>(quads.face_count()));
  report.set("mesh.quads", static_cast<std::int64_t>(after.quads));
  report.set("mesh.triangles", static_cast<std::int64_t>(after.triangles));
  report.set("mesh.pentagons", static_cast<std::int64_t>(after.pentagons));
  report.set("mesh.components", static_cast<std::int64_t>(after.components));
  report.set("mesh.boundary_loops", static_cast<std::int64_t>(after.boundary_loops));
  report.set("mesh.euler_characteristic", after.euler);
  require_same_topology(mesh, after, "the mesh built from the lines");
  if (const std::string defect = halfedge_defect(quads); !defect.empty()) {
    throw AlgorithmError("the mesh built from the lines has no half-edge structure: " + defect +
                         "; please report this model");
  }
  if (after.most_sides > max_sides) {
    throw AlgorithmError("a face has " + std::to_string(after.most_sides) + " sides where " +
                         std::to_string(max_sides) + " are allowed; please report this model");
  }
}

/// The cells between the lines as polygons, and what was done to get there.
struct Cells {
  PolygonGraph graph;
  SimplifyCounts simplified;
  PartitionCounts divided;
  PairingCounts paired;
  RegularisingCounts regularised;
  StripCounts strips = {};
  Index joined = 0;
  Index cut_pieces = 0;
  Index split_features = 0;
  Index redrawn_flats = 0;
  Index thinned_out = 0;  ///< nodes of components that keep their triangles
};

/// Pure quads are made from faces of at most five sides.
Index most_sides(const MeshOptions& options) {
  const auto most = static_cast<Index>(options.max_sides);
  return options.pure_quads ? std::min(most, Index{5}) : most;
}

/// The cells as the lines cut them out. \param cuts  set to the number of pieces that cut besides
PolygonGraph cut_out_cells(const TriMesh& mesh, const LineSet& lines,
                           const std::vector<Index>& component,
                           const std::vector<Triangles>& triangles, const BorderCourse& borders,
                           Index& cuts, Observer& observer) {
  Overlay overlay = build_overlay(mesh, lines, observer);
  keep_triangles(component, triangles, overlay);
  observer.report("forming cells", 0.4);
  cuts = reduce_to_lines(overlay);
  return {mesh, overlay, borders};
}

/// The cells between the lines, simplified and divided to faces of few sides.
/// \param heights  made where there are none yet: not before cells are formed, which takes most
///                 memory
Cells divide_cells(const TriMesh& mesh, const LineSet& lines, const MeshOptions& options,
                   const std::vector<Index>& component, const std::vector<Triangles>& triangles,
                   const BorderCourse& borders, std::optional<EdgeHeights>& heights,
                   Observer& observer) {
  Index cuts = 0;
  Cells cells{
      cut_out_cells(mesh, lines, component, triangles, borders, cuts, observer), {}, {}, {}, {}};
  cells.cut_pieces = cuts;
  observer.report("simplifying cells", 0.6);
  if (!are_all_merged(triangles)) {
    cells.thinned_out = simplify_small_components(cells.graph, component,
                                                  wanted_cells(mesh, lines, component, triangles));
  }
  cells.simplified =
      simplify(cells.graph, [&](const SurfaceNode& node) { return local_size(mesh, lines, node); },
               {.shortest = kShortestEdge, .corner_distance = options.corner_distance});
  hold_triangles(component, triangles, cells.graph);
  if (!heights) heights.emplace(mesh);
  cells.split_features = split_crossing_features(cells.graph);
  observer.report("dividing cells", 0.8);
  cells.divided = partition(cells.graph, most_sides(options), &*heights);
  cells.redrawn_flats = redraw_flats(cells.graph);
  return cells;
}

/// Makes quads of odd faces, vertices of valence four, and as many as are wanted.
/// \param is_held  whether a cell, by a dart of it, is a triangle that stays as it is
void regularise_cells(const TriMesh& mesh, const LineSet& lines, const MeshOptions& options,
                      const EdgeHeights& heights, const std::function<bool(Index)>& is_held,
                      Cells& cells) {
  const auto wanted = [&](Index dart) { return wanted_length(mesh, lines, cells.graph, dart); };
  cells.paired = pair_odd_faces(cells.graph, wanted, options.odd_price, &heights);
  if (options.pure_quads) {
    divide_into_quads(cells.graph, is_held);
    cells.joined = join_odd_faces(cells.graph);
  }
  cells.regularised = regularise(cells.graph, options.valence_price, &heights);
  if (options.strip_vertices > 0) {
    cells.strips = meet_vertex_count(cells.graph, wanted, options.odd_price,
                                     static_cast<Index>(options.strip_vertices));
    // Strips that cannot be taken out in whole leave odd faces.
    if (options.pure_quads) cells.joined += join_odd_faces(cells.graph);
  }
}

/// The faces of the result. \param triangles  [components] set to what became of theirs
Cells form_cells(const TriMesh& mesh, const LineSet& lines, const MeshOptions& options,
                 const BorderCourse& borders, std::vector<Triangles>& triangles,
                 Observer& observer) {
  const std::vector<Index> component = face_components(mesh);
  triangles.assign(*std::max_element(component.begin(), component.end()) + 1, Triangles::merged);
  std::optional<EdgeHeights> heights;
  while (true) {
    Cells cells =
        divide_cells(mesh, lines, options, component, triangles, borders, heights, observer);
    // Seen before the long work is done, as far as it can be.
    if (find_starved(mesh, component, cells.graph, triangles)) continue;
    observer.report("pairing odd faces", 0.9);
    const auto is_held = [&](Index dart) {
      const SurfaceNode& node = cells.graph.node(cells.graph.graph().from(dart));
      return triangles[component[node.at.face]] == Triangles::held;
    };
    regularise_cells(mesh, lines, options, *heights, is_held, cells);
    if (!find_starved(mesh, component, cells.graph, triangles)) return cells;
  }
}

}  // namespace

MeshResult mesh_lines(const TriMesh& mesh, const LineSet& lines, const MeshOptions& options,
                      Observer& observer) {
  const BorderCourse borders =
      border_course(mesh, sizes_at_vertices(mesh, lines.spacing_along_min, lines.spacing_along_max),
                    options.border_distance ? options.border_distance->resolve(mesh.diagonal)
                                            : std::numeric_limits<double>::infinity());
  std::vector<Triangles> triangles;
  const Cells cells = form_cells(mesh, lines, options, borders, triangles, observer);
  MeshResult result;
  result.quads = assemble(mesh, cells.graph);
  const Index at_sharp_points = meet_sharp_points(mesh, !options.pure_quads, result.quads);
  begin_faces_at_fans(result.quads.mesh);
  result.quads.mesh.attributes = carry_attributes(mesh, result.quads.mesh, result.quads.provenance);

  Report& report = result.report;
  const auto merged = std::count(triangles.begin(), triangles.end(), Triangles::merged);
  const auto kept = static_cast<std::int64_t>(triangles.size()) - merged;
  if (kept > 0) {
    report.warn(std::to_string(kept) + " component(s) are smaller than the line distance and " +
                (options.pure_quads ? "are made of their own triangles" : "keep their triangles"));
  }
  report.set("mesh.cut_pieces", static_cast<std::int64_t>(cells.cut_pieces));
  report.set("mesh.components_kept_as_triangles", kept);
  report.set("mesh.nodes_taken_out_of_small_components", std::int64_t{cells.thinned_out});
  report.set("mesh.contracted_edges", static_cast<std::int64_t>(cells.simplified.contracted_edges));
  report.set("mesh.removed_bigons", static_cast<std::int64_t>(cells.simplified.removed_bigons));
  report.set("mesh.removed_loops", static_cast<std::int64_t>(cells.simplified.removed_loops));
  report.set("mesh.dissolved_nodes", static_cast<std::int64_t>(cells.simplified.dissolved_nodes));
  report.set("mesh.divided_edges", static_cast<std::int64_t>(cells.simplified.split_edges));
  report.set("mesh.diagonals", static_cast<std::int64_t>(cells.divided.diagonals));
  report.set("mesh.straightened_nodes", static_cast<std::int64_t>(cells.divided.moved_nodes));
  report.set("mesh.centred_faces", static_cast<std::int64_t>(cells.divided.centred_faces));
  report.set("mesh.crossing_features_split", static_cast<std::int64_t>(cells.split_features));
  report.set("mesh.redrawn_flats", static_cast<std::int64_t>(cells.redrawn_flats));
  report.set("mesh.divided_patches", static_cast<std::int64_t>(cells.paired.divided_patches));
  report.set("mesh.split_strips", static_cast<std::int64_t>(cells.paired.split_strips));
  report.set("mesh.collapsed_strips", static_cast<std::int64_t>(cells.paired.collapsed_strips));
  report.set("mesh.redivided_quads", static_cast<std::int64_t>(cells.regularised.divided_patches));
  report.set("mesh.closed_quads", static_cast<std::int64_t>(cells.regularised.closed_quads));
  report.set("mesh.strips_split_for_count", static_cast<std::int64_t>(cells.strips.split));
  report.set("mesh.strips_collapsed_for_count", static_cast<std::int64_t>(cells.strips.collapsed));
  report.set("mesh.vertices_at_sharp_points", static_cast<std::int64_t>(at_sharp_points));
  report.set("mesh.joined_odd_faces", static_cast<std::int64_t>(cells.joined));
  check_result(mesh, result.quads.mesh, static_cast<Index>(options.max_sides), report);
  if (options.pure_quads && analyse(result.quads.mesh).quads != result.quads.mesh.face_count()) {
    throw AlgorithmError("some faces could not be made quads; please report this model");
  }
  return result;
}

}  // namespace strake
