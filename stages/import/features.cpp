#include "stages/import/features.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/import/attribute_borders.h"
#include "stages/import/corner_facets.h"
#include "stages/import/face_normals.h"
#include "stages/import/facets.h"
#include "stages/import/feature_graph.h"
#include "stages/import/feature_noise.h"
#include "stages/import/shallow_creases.h"
#include "stages/import/sharp_points.h"

namespace strake::import {
namespace {

/// Angle by which the surface is bent at each half-edge's edge; 0 on the boundary.
std::vector<float> bend_angles(const TriMesh& mesh, const std::vector<Vec3>& normals) {
  std::vector<float> bend(mesh.halfedge_count(), 0);
  tbb::parallel_for(Index{0}, mesh.halfedge_count(), [&](Index h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone || h > twin) return;
    bend[h] = bend[twin] = static_cast<float>(angle_between(normals[h / 3], normals[twin / 3]));
  });
  return bend;
}

/// The n-th least of the numbers in some lists. \pre each list ascends, and there is one
template <std::size_t N>
float nth_of_sorted(const std::array<std::span<const float>, N>& lists, std::size_t n) {
  const auto count_up_to = [&](float value) {
    std::size_t count = 0;
    for (const auto& list : lists) {
      count += static_cast<std::size_t>(std::ranges::upper_bound(list, value) - list.begin());
    }
    return count;
  };
  float least = std::numeric_limits<float>::infinity();
  for (const auto& list : lists) {
    const auto at =
        std::ranges::partition_point(list, [&](float value) { return count_up_to(value) <= n; });
    if (at != list.end()) least = std::min(least, *at);
  }
  return least;
}

/// What the median bend around an edge exceeds that of a smooth, finely meshed surface by. The
/// edges at its four vertices count that are bent by at most `angle`, but for those that are no
/// noise, and the spokes of an even fan: those around the tip of a cone are many.
class Roughness {
 public:
  /// \param is_no_noise  [3F] edges that are no noise
  Roughness(const TriMesh& mesh, const std::vector<float>& bend,
            const std::vector<std::uint8_t>& is_no_noise, double angle)
      : mesh_(mesh), bend_(bend), is_no_noise_(is_no_noise), angle_(angle) {}

  double operator()(Index h) {
    const std::array<Index, 4> vertices = {mesh_.from(h), mesh_.to(h), mesh_.from(TriMesh::prev(h)),
                                           mesh_.from(TriMesh::prev(mesh_.twin[h]))};
    for (std::size_t i = 0; i < vertices.size(); ++i) bends_[i] = bends_at(vertices[i], own_[i]);
    return std::max(share_of_bends(0.5) - kSmooth, 0.0);
  }

  /// The bend that a quarter of the edges around the last one have at most.
  [[nodiscard]] double quarter() const { return share_of_bends(0.25); }

 private:
  static constexpr double kSmooth = 5 * kDegree;
  /// Spokes that are bent like the two beside them make an even fan, if they are so many.
  static constexpr std::size_t kFewestSpokes = 5;
  static constexpr float kEven = 0.8F;  ///< share of the larger bend that the smaller one has
  /// Edges at a vertex from which on their bends are kept for the others of them.
  static constexpr std::size_t kHub = 64;

  /// The bend that this share of the edges around the last one have at most; 0 where none counts.
  [[nodiscard]] double share_of_bends(double share) const {
    std::size_t count = 0;
    for (const auto& bends : bends_) count += bends.size();
    if (count == 0) return 0;
    return nth_of_sorted(bends_, static_cast<std::size_t>(share * static_cast<double>(count)));
  }

  /// Those at a vertex that count, ascending. \param own  holds them where they are not kept
  std::span<const float> bends_at(Index v, std::vector<float>& own) {
    if (const auto hub = hubs_.find(v); hub != hubs_.end()) return hub->second;
    own.clear();
    around_.clear();
    for_each_outgoing(mesh_, v,
                      [&](Index e) { around_.push_back(mesh_.twin[e] != kNone ? bend_[e] : 0); });
    const std::size_t count = around_.size();
    const auto is_spoke = [&](std::size_t i) {
      const auto [least, most] =
          std::minmax({around_[(i + count - 1) % count], around_[i], around_[(i + 1) % count]});
      return least > kSmooth && least >= kEven * most;
    };
    std::size_t spokes = 0;
    for (std::size_t i = 0; i < count; ++i) spokes += is_spoke(i) ? 1 : 0;
    const bool is_fan = spokes >= kFewestSpokes;
    std::size_t i = 0;
    for_each_outgoing(mesh_, v, [&](Index e) {
      const bool counts = mesh_.twin[e] != kNone && bend_[e] <= angle_ && is_no_noise_[e] == 0 &&
                          !(is_fan && is_spoke(i));
      if (counts) own.push_back(bend_[e]);
      ++i;
    });
    std::sort(own.begin(), own.end());
    if (count < kHub) return own;
    return hubs_.emplace(v, own).first->second;
  }

  const TriMesh& mesh_;
  const std::vector<float>& bend_;
  const std::vector<std::uint8_t>& is_no_noise_;
  double angle_;
  std::unordered_map<Index, std::vector<float>> hubs_;  ///< what `bends_at` gives
  std::array<std::vector<float>, 4> own_;
  std::array<std::span<const float>, 4> bends_;  ///< at the vertices around the last edge
  std::vector<float> around_;                    ///< bends at one vertex
};

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

/// Flags those of some edges that `drop`, which sees them alone, leaves. \return their number
template <class Drop>
Index add_lines(TriMesh& mesh, const std::vector<Index>& edges, const Drop& drop) {
  const std::vector<std::uint8_t> others =
      std::exchange(mesh.is_feature, std::vector<std::uint8_t>(mesh.halfedge_count(), 0));
  for (const Index h : edges) set_feature(mesh, h, true);
  const Index dropped = drop();
  for (Index h = 0; h < mesh.halfedge_count(); ++h) mesh.is_feature[h] |= others[h];
  return static_cast<Index>(edges.size()) - dropped;
}

/// Flags those of some edges that are connected to lines of some length among themselves.
Index add_long_enough(TriMesh& mesh, const std::vector<Index>& edges) {
  constexpr double kShortestShallow = 0.05;  // share of the diagonal
  return add_lines(mesh, edges,
                   [&] { return drop_shorter(mesh, kShortestShallow * mesh.diagonal); });
}

/// Flags those of some edges that make lines across strips from features to features.
Index add_links(TriMesh& mesh, const std::vector<Vec3>& normals, std::vector<Index> edges) {
  std::erase_if(edges,
                [&](Index h) { return mesh.is_feature[h] != 0 || !lies_across(mesh, normals, h); });
  const std::vector<Index> degree = barrier_degrees(mesh);
  return add_lines(mesh, edges, [&] { return drop_loose(mesh, degree); });
}

/// Flags the edges around facets all of whose corners lie on creases. \return their number
Index add_around(TriMesh& mesh, const std::vector<std::vector<Index>>& facets) {
  const std::vector<Index> degree = barrier_degrees(mesh);
  Index added = 0;
  for (const std::vector<Index>& around : facets) {
    if (!std::ranges::all_of(around, [&](Index h) { return degree[mesh.from(h)] > 1; })) continue;
    for (const Index h : around) {
      added += 1 - mesh.is_feature[h];
      set_feature(mesh, h, true);
    }
  }
  return added;
}

double length_of_features(const TriMesh& mesh) {
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (h < mesh.twin[h] && mesh.is_feature[h] != 0) {
      length += edge_length(mesh, h);
    }
  }
  return length;
}

void leave_noise_out(TriMesh& mesh, const std::vector<float>& roughness, FeatureCounts& counts) {
  const double before = length_of_features(mesh);
  if (before == 0) return;
  counts.dropped_edges = drop_noise(mesh, roughness);
  counts.dropped_length = before - length_of_features(mesh);
  counts.dropped_share = counts.dropped_length / before;
}

void find_creases(TriMesh& mesh, double angle_deg, bool all, FeatureCounts& counts) {
  constexpr double kShallow = 0.5;
  constexpr double kWeak = 0.6;
  constexpr double kSmoothGround = 0.05;
  constexpr double kRoughness = 3;
  const double angle = angle_deg * kDegree;
  const std::vector<Vec3> normals = robust_face_normals(mesh);
  const std::vector<float> bend = bend_angles(mesh, normals);
  const std::vector<std::vector<Index>> corners =
      find_corner_facets(mesh, bend, kShallow * angle, angle);
  std::vector<std::uint8_t> is_around_corner(bend.size(), 0);
  for (const std::vector<Index>& around : corners) {
    for (const Index h : around) is_around_corner[h] = is_around_corner[mesh.twin[h]] = 1;
  }
  Roughness roughness(mesh, bend, is_around_corner, angle);
  std::vector<float> excess(bend.size(), 0);  // bend beyond the roughness, where it matters
  std::vector<float> rough_at(bend.size(), 0);
  std::vector<Index> shallow;  // bent less than creases, on smooth ground
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == kNone || h > mesh.twin[h] || bend[h] <= kShallow * angle) continue;
    const double rough = roughness(h);
    rough_at[h] = rough_at[mesh.twin[h]] = static_cast<float>(rough);
    excess[h] = excess[mesh.twin[h]] = static_cast<float>(bend[h] - rough);
    if (bend[h] - kRoughness * rough > angle) {
      set_feature(mesh, h, true);
      ++counts.strong_edges;
    } else if (rough == 0 && roughness.quarter() <= kSmoothGround * bend[h]) {
      shallow.push_back(h);
    }
  }
  std::erase_if(shallow, [&](Index h) { return !stands_alone(mesh, normals, h, bend[h]); });
  counts.shallow_edges = add_long_enough(mesh, shallow);
  counts.bridging_edges = Bridges(mesh, excess, kWeak * angle).run();
  if (!all) leave_noise_out(mesh, rough_at, counts);
  counts.shallow_edges += add_links(mesh, normals, shallow);  // noise holds none
  counts.shallow_edges += add_around(mesh, corners);
}

/// How far an edge stands out over the straight way across its two faces.
double ridge_height(const TriMesh& mesh, Index h) {
  const Vec3& a = mesh.positions[mesh.from(h)];
  const Vec3 along = direction(mesh, h);
  const auto across = [&](Index side) {  // from the edge to the corner opposite, in section
    const Vec3 d = mesh.positions[mesh.from(TriMesh::prev(side))] - a;
    return Vec3(d - along * along.dot(d));
  };
  const Vec3 p = across(h);
  const Vec3 q = across(mesh.twin[h]);
  const double way = (q - p).norm();
  return way > 0 ? p.cross(q).norm() / way : p.norm();
}

void find_ridges(TriMesh& mesh, double height, FeatureCounts& counts) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == kNone || h > mesh.twin[h] || mesh.is_feature[h] != 0) continue;
    if (!(ridge_height(mesh, h) > height)) continue;
    ++counts.ridge_edges;
    set_feature(mesh, h, true);
  }
}

/// Where most edges of facets, by length, stand out by more than the height all are kept: between
/// some edges of a round lines run askew over the others.
void find_facets(TriMesh& mesh, double height, FeatureCounts& counts) {
  constexpr double kMost = 0.5;
  const std::vector<float> bend = bend_angles(mesh, robust_face_normals(mesh));
  std::vector<Index> edges = find_facet_edges(mesh, bend);
  double length = 0;
  double high = 0;
  for (const Index h : edges) {
    const double way = edge_length(mesh, h);
    length += way;
    if (ridge_height(mesh, h) > height) high += way;
  }
  if (high < kMost * length) {
    std::erase_if(edges, [&](Index h) { return !(ridge_height(mesh, h) > height); });
  }
  for (const Index h : edges) set_feature(mesh, h, true);
  counts.facet_edges = static_cast<Index>(edges.size());
}

/// Makes borders of attributes features where the rules want them, and then those listed.
void flag_borders_and_listed_edges(const FeatureRules& rules, const ListedEdges* listed,
                                   TriMesh& mesh, FeatureCounts& counts) {
  std::vector<Index> borders;
  std::vector<Index> seams;
  const MirrorLines mirrors(mesh);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == kNone || h > mesh.twin[h]) continue;
    if (is_label_border(mesh, h)) borders.push_back(h);
    if (is_seam(mesh, h) || mirrors.contains(h)) seams.push_back(h);
  }
  const auto flag = [&](const std::vector<Index>& edges) {
    for (const Index h : edges) set_feature(mesh, h, true);
    return static_cast<Index>(edges.size());
  };
  if (rules.labels) counts.label_edges = flag(borders);
  if (rules.seams) {
    if (rules.labels) std::erase_if(seams, [&](Index h) { return is_label_border(mesh, h); });
    counts.seam_edges = flag(seams);
  }
  if (listed != nullptr) counts.listed_edges = listed->flag(mesh);
  const auto open = [&](const std::vector<Index>& edges) {
    return static_cast<Index>(
        std::ranges::count_if(edges, [&](Index h) { return mesh.is_feature[h] == 0; }));
  };
  counts.open_label_edges = open(borders);
  counts.open_seam_edges = open(seams);
}

}  // namespace

FeatureCounts find_features(TriMesh& mesh, const FeatureRules& rules, const ListedEdges* listed) {
  FeatureCounts counts;
  mesh.is_feature.assign(mesh.halfedge_count(), 0);
  if (rules.angle_deg < 180) find_creases(mesh, rules.angle_deg, rules.all_creases, counts);
  if (std::isfinite(rules.height)) find_ridges(mesh, rules.height, counts);
  if (std::isfinite(rules.facet_height)) find_facets(mesh, rules.facet_height, counts);
  flag_borders_and_listed_edges(rules, listed, mesh, counts);
  counts.edges =
      static_cast<Index>(std::count(mesh.is_feature.begin(), mesh.is_feature.end(), 1) / 2);
  counts.corners = find_corners(mesh);
  if (rules.angle_deg < 180) counts.sharp_points = find_sharp_points(mesh);
  return counts;
}

}  // namespace strake::import
