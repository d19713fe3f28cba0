#include "stages/fit/guide_vertices.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cstddef>
#include <limits>

#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/surface_point.h"

namespace strake::fitting {
namespace {

/// A vertex nearer to a guide line than this share of its shortest edge is beside it.
constexpr double kBeside = 0.25;

/// [V]
std::vector<double> shortest_edges(const PolyMesh& mesh) {
  std::vector<double> shortest(mesh.positions.size(), std::numeric_limits<double>::infinity());
  const PolyEdges edges = collect_edges(mesh);
  for (Index e = 0; e < edges.edge_count(); ++e) {
    const auto& [a, b] = edges.vertices[e];
    const double length = (mesh.positions[b] - mesh.positions[a]).norm();
    shortest[a] = std::min(shortest[a], length);
    shortest[b] = std::min(shortest[b], length);
  }
  return shortest;
}

}  // namespace

std::vector<std::optional<Vec3>> ways_to_guides(const TriMesh& mesh, const QuadMesh& quads,
                                                const LaidGuides& guides) {
  std::vector<std::optional<Vec3>> ways(quads.mesh.positions.size());
  if (guides.piece_count() == 0) return ways;
  std::vector<Vec3> ends;
  SurfaceDistance::Triangles pieces;  // of a segment each
  for (Index p = 0; p < guides.piece_count(); ++p) {
    const Vec3& share = guides.barycentric[p];
    const Vec3 middle = place_of(mesh, {guides.face[p], {share[0], share[1], share[2]}});
    ends.push_back(middle - guides.step[p] / 2);
    ends.push_back(middle + guides.step[p] / 2);
    pieces.push_back({2 * p, 2 * p + 1, 2 * p + 1});
  }
  const SurfaceDistance lines(ends, pieces);
  const std::vector<double> shortest = shortest_edges(quads.mesh);
  tbb::parallel_for(std::size_t{0}, ways.size(), [&](std::size_t v) {
    const Vec3 foot = place_of(mesh, foot_of(quads.provenance, static_cast<Index>(v)));
    const ClosestPoint nearest = lines.closest_within(foot, kBeside * shortest[v]);
    if (nearest.triangle != kNone) ways[v] = lines.point(nearest) - foot;
  });
  return ways;
}

}  // namespace strake::fitting
