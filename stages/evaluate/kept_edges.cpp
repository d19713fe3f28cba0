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
constexpr double kSagitta = 0.05;          // of the candidate's edge
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

/// The candidate's edges, to ask which of them keeps a place of a reference line.
class KeepingEdges {
 public:
  /// \param positions  kept by reference
  /// \param lines      the reference lines themselves
  KeepingEdges(const std::vector<Vec3>& positions, EdgeTriangles triangles,
               const SurfaceDistance& lines, double reach)
      : triangles_(std::move(triangles)),
        edges_(positions, triangles_),
        reach_(reach),
        farthest_(reach) {
    const auto is_on_line = [&](Index v) {
      return lines.closest_if(positions[v], reach, [](Index) { return true; }).triangle != kNone;
    };
    for (const auto& ends : edges_.triangles()) {
      const double length = (positions[ends[1]] - positions[ends[0]]).norm();
      const bool is_chord = is_on_line(ends[0]) && is_on_line(ends[1]);
      reach_of_.push_back(is_chord ? std::max(reach, kSagitta * length) : reach);
      farthest_ = std::max(farthest_, reach_of_.back());
    }
  }

  /// Length of the part of segment `a`-`b` that is kept.
  [[nodiscard]] double kept_length(const Vec3& a, const Vec3& b) const {
    const Vec3 along = b - a;
    const double length = along.norm();
    const int count = 1 + static_cast<int>(std::min(2 * length / reach_, 1e6));
    int kept = 0;
    for (int i = 0; i < count; ++i) {
      const Vec3 p = a + (i + 0.5) / count * along;
      const auto keeps = [&](Index e) { return is_parallel(e, along) && is_within_reach(e, p); };
      if (edges_.closest_if(p, farthest_, keeps).triangle != kNone) ++kept;
    }
    return length * kept / count;
  }

 private:
  [[nodiscard]] Vec3 vector(Index e) const {
    const auto& ends = edges_.triangles()[e];
    return edges_.positions()[ends[1]] - edges_.positions()[ends[0]];
  }
  [[nodiscard]] bool is_parallel(Index e, const Vec3& along) const {
    const Vec3 other = vector(e);
    return std::abs(other.dot(along)) >= kParallelCosine * other.norm() * along.norm();
  }
  /// Beyond the ends of an edge, and where it is no chord, the plain reach counts.
  [[nodiscard]] bool is_within_reach(Index e, const Vec3& p) const {
    const Vec3 other = vector(e);
    const Vec3 offset = p - edges_.positions()[edges_.triangles()[e][0]];
    const double share = offset.dot(other) / std::max(other.squaredNorm(), 1e-300);
    const double distance = (offset - std::clamp(share, 0.0, 1.0) * other).norm();
    return distance <= (share >= 0 && share <= 1 ? reach_of_[e] : reach_);
  }

  EdgeTriangles triangles_;
  SurfaceDistance edges_;
  double reach_;
  double farthest_;
  std::vector<double> reach_of_;  ///< of each edge
};

void report_kind(const std::string& kind, const TriMesh& reference,
                 const std::vector<Index>& halfedges, const std::vector<Vec3>& positions,
                 EdgeTriangles triangles, Report& report) {
  double total = 0;
  EdgeTriangles lines;
  for (const Index h : halfedges) {
    total += (reference.positions[reference.to(h)] - reference.positions[reference.from(h)]).norm();
    lines.push_back({reference.from(h), reference.to(h), reference.to(h)});
  }
  report.set(kind + ".reference_length", total);
  if (halfedges.empty()) return;  // nothing that could be kept
  double kept = 0;
  if (!triangles.empty()) {
    const KeepingEdges edges(positions, std::move(triangles),
                             SurfaceDistance(reference.positions, lines),
                             kReach * reference.diagonal);
    std::vector<double> lengths(halfedges.size());
    tbb::parallel_for(std::size_t{0}, halfedges.size(), [&](std::size_t i) {
      const Index h = halfedges[i];
      lengths[i] = edges.kept_length(reference.positions[reference.from(h)],
                                     reference.positions[reference.to(h)]);
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
