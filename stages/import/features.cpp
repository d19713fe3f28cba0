#include "stages/import/features.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "stages/import/face_normals.h"
#include "stages/import/feature_graph.h"

namespace strake::import {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// Angle by which the surface is bent at each half-edge's edge; 0 on the boundary.
std::vector<float> bend_angles(const TriMesh& mesh) {
  const std::vector<Vec3> normals = robust_face_normals(mesh);
  std::vector<float> bend(mesh.halfedge_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || h > twin) continue;
    bend[h] = bend[twin] = static_cast<float>(angle_between(normals[h / 3], normals[twin / 3]));
  }
  return bend;
}

/// Calls `visit` with every half-edge that leaves a vertex.
template <typename Visit>
void for_each_outgoing(const TriMesh& mesh, Index vertex, const Visit& visit) {
  const Index start = mesh.vertex_out[vertex];
  Index h = start;
  do {
    visit(h);
    h = mesh.rotate_ccw(h);
  } while (h != kNone && h != start);
}

/// What the median bend around an edge exceeds that of a smooth, finely meshed surface by. The
/// edges at its four vertices count that are bent by at most `angle`.
class Roughness {
 public:
  Roughness(const TriMesh& mesh, const std::vector<float>& bend, double angle)
      : mesh_(mesh), bend_(bend), angle_(angle) {}

  double operator()(Index h) {
    bends_.clear();
    for (const Index v : {mesh_.from(h), mesh_.to(h), mesh_.from(TriMesh::prev(h)),
                          mesh_.from(TriMesh::prev(mesh_.twin[h]))}) {
      for_each_outgoing(mesh_, v, [&](Index e) {
        if (mesh_.twin[e] != kNone && bend_[e] <= angle_) bends_.push_back(bend_[e]);
      });
    }
    if (bends_.empty()) return 0;
    const auto middle = bends_.begin() + static_cast<std::ptrdiff_t>(bends_.size() / 2);
    std::nth_element(bends_.begin(), middle, bends_.end());
    return std::max(*middle - kSmooth, 0.0);
  }

 private:
  static constexpr double kSmooth = 5 * kDegree;

  const TriMesh& mesh_;
  const std::vector<float>& bend_;
  double angle_;
  std::vector<float> bends_;
};

void set_feature(TriMesh& mesh, Index h, bool value) {
  mesh.is_feature[h] = mesh.is_feature[mesh.twin[h]] = value ? 1 : 0;
}

Vec3 direction(const TriMesh& mesh, Index h) {
  return (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).stableNormalized();
}

/// Continues creases that end in the open along weakly bent edges, up to the next crease.
class Bridges {
 public:
  /// \param excess  [3F] bend beyond the roughness
  Bridges(TriMesh& mesh, const std::vector<float>& excess, double weak)
      : mesh_(mesh), excess_(excess), weak_(weak), degree_(barrier_degrees(mesh)) {}

  Index run() {
    const std::vector<Index> degree = degree_;
    Index added = 0;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (degree[v] != 1 || degree_[v] != 1) continue;
      const std::vector<Index> path = find_path(v);
      for (const Index h : path) {
        set_feature(mesh_, h, true);
        ++degree_[mesh_.from(h)];
        ++degree_[mesh_.to(h)];
        ++added;
      }
    }
    return added;
  }

 private:
  /// Half-edges from the end of a crease to another; empty where there is no way.
  std::vector<Index> find_path(Index end) {
    constexpr std::size_t kLongest = 1000;
    Index last = kNone;
    for_each_outgoing(mesh_, end, [&](Index h) {
      if (mesh_.is_feature[h] != 0) last = mesh_.twin[h];
    });
    std::vector<Index> path;
    while (last != kNone && path.size() < kLongest) {
      last = next_edge(last);
      if (last == kNone) break;
      path.push_back(last);
      if (degree_[mesh_.to(last)] > 0) return path;
    }
    return {};
  }

  /// The weakly bent edge that goes on most nearly straight from a half-edge.
  [[nodiscard]] Index next_edge(Index last) const {
    const Vec3 heading = direction(mesh_, last);
    constexpr double kStraight = 0.7;  // cosine of about 45 degrees
    double best_cosine = kStraight;
    Index best = kNone;
    for_each_outgoing(mesh_, mesh_.to(last), [&](Index h) {
      if (mesh_.is_barrier(h) || excess_[h] <= weak_) return;
      const double cosine = direction(mesh_, h).dot(heading);
      if (cosine > best_cosine) {
        best_cosine = cosine;
        best = h;
      }
    });
    return best;
  }

  TriMesh& mesh_;
  const std::vector<float>& excess_;
  double weak_;
  std::vector<Index> degree_;
};

constexpr double kShortest = 0.02;  ///< length of a feature, share of the diagonal

double edge_length(const TriMesh& mesh, Index h) {
  return (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
}

/// Cuts off loose ends that are too short, until none is left.
Index drop_loose_ends(TriMesh& mesh) {
  std::vector<Index> degree = barrier_degrees(mesh);
  std::vector<Index> ends;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (degree[v] == 1) ends.push_back(v);
  }
  Index dropped = 0;
  std::vector<Index> branch;
  while (!ends.empty()) {
    Index v = ends.back();
    ends.pop_back();
    branch.clear();
    double length = 0;
    do {
      Index onward = kNone;
      for_each_outgoing(mesh, v, [&](Index h) {
        const bool is_way_back = !branch.empty() && h == mesh.twin[branch.back()];
        if (mesh.is_feature[h] != 0 && !is_way_back) onward = h;
      });
      if (onward == kNone) break;
      branch.push_back(onward);
      length += edge_length(mesh, onward);
      v = mesh.to(onward);
    } while (degree[v] == 2 && length < kShortest * mesh.diagonal);
    // What ends loose on both sides is a piece of its own; the boundary holds what reaches it.
    if (branch.empty() || length >= kShortest * mesh.diagonal || degree[v] < 3) continue;
    if (mesh.is_boundary(mesh.vertex_out[v])) continue;
    for (const Index h : branch) {
      set_feature(mesh, h, false);
      --degree[mesh.from(h)];
      --degree[mesh.to(h)];
    }
    dropped += static_cast<Index>(branch.size());
    if (degree[v] == 1) ends.push_back(v);
  }
  return dropped;
}

/// Takes the flags off connected pieces too short to be features.
Index drop_short_pieces(TriMesh& mesh) {
  const std::vector<Index> degree = barrier_degrees(mesh);
  std::vector<std::uint8_t> seen(mesh.halfedge_count(), 0);
  Index dropped = 0;
  std::vector<Index> piece;
  for (Index seed = 0; seed < mesh.halfedge_count(); ++seed) {
    if (mesh.is_feature[seed] == 0 || seen[seed] != 0) continue;
    piece.assign(1, seed);
    seen[seed] = seen[mesh.twin[seed]] = 1;
    double length = 0;
    bool is_simple_loop = true;
    bool meets_boundary = false;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      length += edge_length(mesh, piece[i]);
      for (const Index v : {mesh.from(piece[i]), mesh.to(piece[i])}) {
        is_simple_loop = is_simple_loop && degree[v] == 2;
        meets_boundary = meets_boundary || mesh.is_boundary(mesh.vertex_out[v]);
        for_each_outgoing(mesh, v, [&](Index h) {
          if (mesh.is_feature[h] == 0 || seen[h] != 0) return;
          seen[h] = seen[mesh.twin[h]] = 1;
          piece.push_back(h);
        });
      }
    }
    if (length >= kShortest * mesh.diagonal || is_simple_loop || meets_boundary) continue;
    for (const Index h : piece) set_feature(mesh, h, false);
    dropped += static_cast<Index>(piece.size());
  }
  return dropped;
}

}  // namespace

FeatureCounts find_features(TriMesh& mesh, double angle_deg) {
  FeatureCounts counts;
  mesh.is_feature.assign(mesh.halfedge_count(), 0);
  if (angle_deg < 180) {
    constexpr double kWeak = 0.6;
    constexpr double kRoughness = 3;
    const double angle = angle_deg * kDegree;
    const std::vector<float> bend = bend_angles(mesh);
    Roughness roughness(mesh, bend, angle);
    std::vector<float> excess(bend.size(), 0);  // bend beyond the roughness, where it matters
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (mesh.twin[h] == kNone || h > mesh.twin[h] || bend[h] <= kWeak * angle) continue;
      const double rough = roughness(h);
      excess[h] = excess[mesh.twin[h]] = static_cast<float>(bend[h] - rough);
      if (bend[h] - kRoughness * rough <= angle) continue;
      set_feature(mesh, h, true);
      ++counts.strong_edges;
    }
    counts.bridging_edges = Bridges(mesh, excess, kWeak * angle).run();
    counts.dropped_edges = drop_loose_ends(mesh);
    counts.dropped_edges += drop_short_pieces(mesh);
  }
  counts.edges = counts.strong_edges + counts.bridging_edges - counts.dropped_edges;
  counts.corners = find_corners(mesh);
  return counts;
}

}  // namespace strake::import
