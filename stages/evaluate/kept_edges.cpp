#include "stages/evaluate/kept_edges.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/evaluate/statistics.h"

namespace strake::evaluation {
namespace {

constexpr double kReach = 0.001;           // of the diagonal
constexpr double kParallelCosine = 0.866;  // 30 degrees

/// Edges of the candidate as degenerate triangles, to ask for the nearest.
using EdgeTriangles = std::vector<std::array<Index, 3>>;

EdgeTriangles edges_as_triangles(const PolyEdges& edges, bool boundary_only) {
  EdgeTriangles triangles;
  for (Index e = 0; e < edges.edge_count(); ++e) {
    if (boundary_only && edges.sides_of(e).size() != 1) continue;
    const auto& [a, b] = edges.vertices[e];
    triangles.push_back({a, b, b});
  }
  return triangles;
}

/// Length of the part of segment `a`-`b` that is near a parallel edge.
double kept_length(const SurfaceDistance& edges, const Vec3& a, const Vec3& b, double reach) {
  const Vec3 along = b - a;
  const double length = along.norm();
  const auto is_parallel = [&](Index e) {
    const auto& ends = edges.triangles()[e];
    const Vec3 other = edges.positions()[ends[1]] - edges.positions()[ends[0]];
    return std::abs(other.dot(along)) >= kParallelCosine * other.norm() * length;
  };
  const int count = 1 + static_cast<int>(std::min(2 * length / reach, 1e6));
  int kept = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p = a + (i + 0.5) / count * along;
    if (edges.closest_if(p, reach, is_parallel).triangle != kNone) ++kept;
  }
  return length * kept / count;
}

void report_kind(const std::string& kind, const TriMesh& reference,
                 const std::vector<Index>& halfedges, const std::vector<Vec3>& positions,
                 EdgeTriangles triangles, Report& report) {
  double total = 0;
  for (const Index h : halfedges) {
    total += (reference.positions[reference.to(h)] - reference.positions[reference.from(h)]).norm();
  }
  report.set(kind + ".reference_length", total);
  if (halfedges.empty()) return;  // nothing that could be kept
  double kept = 0;
  if (!triangles.empty()) {
    const SurfaceDistance nearest(positions, std::move(triangles));
    std::vector<double> lengths(halfedges.size());
    tbb::parallel_for(std::size_t{0}, halfedges.size(), [&](std::size_t i) {
      const Index h = halfedges[i];
      lengths[i] = kept_length(nearest, reference.positions[reference.from(h)],
                               reference.positions[reference.to(h)], kReach * reference.diagonal);
    });
    for (const double length : lengths) kept += length;
  }
  report.set(kind + ".kept_share", share(kept, total));
}

}  // namespace

void report_kept_edges(const TriMesh& reference, const PolyMesh& candidate, const PolyEdges& edges,
                       Report& report) {
  std::vector<Index> features;
  std::vector<Index> boundary;
  for (Index h = 0; h < reference.halfedge_count(); ++h) {
    if (reference.is_boundary(h)) {
      boundary.push_back(h);
    } else if (reference.is_feature[h] != 0 && reference.edge_of(h) == h) {
      features.push_back(h);
    }
  }
  report_kind("features", reference, features, candidate.positions,
              edges_as_triangles(edges, false), report);
  report_kind("boundary", reference, boundary, candidate.positions, edges_as_triangles(edges, true),
              report);
}

}  // namespace strake::evaluation
