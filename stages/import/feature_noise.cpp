#include "stages/import/feature_noise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/frames.h"
#include "common/geometry/topology/topology.h"
#include "common/geometry/topology/vertex_ring.h"
#include "stages/import/feature_graph.h"
#include "stages/import/noise.h"

namespace strake::import {
namespace {

constexpr double kRoughGround = 2 * kDegree;
constexpr double kJagged = 15 * kDegree;
constexpr std::size_t kFewestToJudge = 3;  ///< edges of a line whose turn can change
constexpr std::size_t kFewestEdges = 8;
constexpr std::size_t kAroundOneFace = 3;

Vec3 edge_vector(const TriMesh& mesh, Index h) {
  return mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)];
}

/// The rotation that turns one direction into another, as axis times angle.
Vec3 turn_between(const Vec3& a, const Vec3& b) {
  const Vec3 axis = a.cross(b);
  const double sine = axis.norm();
  return sine > 0 ? Vec3(axis * (std::atan2(sine, a.dot(b)) / sine)) : Vec3(Vec3::Zero());
}

/// Half of what the turn of a line changes by from vertex to vertex, averaged over its length.
/// \param line  half-edges, each starting where the one before ends
double jaggedness(const TriMesh& mesh, const std::vector<Index>& line) {
  const std::size_t count = line.size();
  const bool is_closed = mesh.to(line.back()) == mesh.from(line.front());
  std::vector<Vec3> turns(count, Vec3::Zero());  // at the start of each edge
  for (std::size_t i = is_closed ? 0 : 1; i < count; ++i) {
    turns[i] =
        turn_between(edge_vector(mesh, line[(i + count - 1) % count]), edge_vector(mesh, line[i]));
  }
  double changes = 0;
  double length = 0;
  for (std::size_t i = is_closed ? 0 : 1; i < (is_closed ? count : count - 1); ++i) {
    const double weight = edge_vector(mesh, line[i]).norm();
    changes += weight * 0.5 * (turns[(i + 1) % count] - turns[i]).norm();
    length += weight;
  }
  return length > 0 ? changes / length : 0;
}

/// The feature edge that leads on from `h` where just two meet; kNone elsewhere.
Index next_on_line(const TriMesh& mesh, const std::vector<Index>& degree, Index h) {
  Index onward = kNone;
  if (degree[mesh.to(h)] != 2) return kNone;
  for_each_outgoing(mesh, mesh.to(h), [&](Index e) {
    if (mesh.is_feature[e] != 0 && e != mesh.twin[h]) onward = e;
  });
  return onward;
}

/// Mean of the roughness along a line.
double mean_roughness(const TriMesh& mesh, const std::vector<float>& roughness,
                      const std::vector<Index>& line) {
  double sum = 0;
  double length = 0;
  for (const Index h : line) {
    const double weight = edge_vector(mesh, h).norm();
    sum += weight * roughness[h];
    length += weight;
  }
  return length > 0 ? sum / length : 0;
}

/// Takes the flags off lines between nodes, and closed ones, that are noise.
class NoisyLines {
 public:
  NoisyLines(TriMesh& mesh, const std::vector<float>& roughness)
      : mesh_(mesh),
        roughness_(roughness),
        degree_(barrier_degrees(mesh)),
        seen_(mesh.halfedge_count(), 0) {}

  /// \return edges dropped; lines that joined where others went are for another run
  Index drop() {
    Index dropped = 0;
    for (const bool closed : {false, true}) {
      for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
        if (mesh_.is_feature[h] == 0 || seen_[h] != 0) continue;
        if (!closed && degree_[mesh_.from(h)] == 2) continue;
        collect(h);
        if (!is_noise()) continue;
        for (const Index e : line_) set_feature(mesh_, e, false);
        dropped += static_cast<Index>(line_.size());
      }
    }
    return dropped;
  }

 private:
  void collect(Index start) {
    line_.clear();
    for (Index h = start; h != kNone && seen_[h] == 0; h = next_on_line(mesh_, degree_, h)) {
      seen_[h] = seen_[mesh_.twin[h]] = 1;
      line_.push_back(h);
    }
  }

  [[nodiscard]] bool is_noise() const {
    const Index first = mesh_.from(line_.front());
    const Index last = mesh_.to(line_.back());
    if (first == last && line_.size() == kAroundOneFace) return true;
    if (mean_roughness(mesh_, roughness_, line_) <= kRoughGround) return false;
    const bool is_held = first != last && degree_[first] > 1 && degree_[last] > 1;
    if (!is_held && line_.size() < kFewestEdges) return true;
    return line_.size() >= kFewestToJudge && jaggedness(mesh_, line_) > kJagged;
  }

  TriMesh& mesh_;
  const std::vector<float>& roughness_;
  std::vector<Index> degree_;
  std::vector<std::uint8_t> seen_;  ///< [3F]
  std::vector<Index> line_;         ///< half-edges, each starting where the one before ends
};

constexpr double kShortestFeature = 0.02;  ///< length of a feature, share of the diagonal

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
      length += edge_vector(mesh, onward).norm();
      v = mesh.to(onward);
    } while (degree[v] == 2 && length < kShortestFeature * mesh.diagonal);
    // What ends loose on both sides is a piece of its own; the boundary holds what reaches it.
    if (branch.empty() || length >= kShortestFeature * mesh.diagonal || degree[v] < 3) continue;
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

/// Calls drops(piece) for the half-edges of each connected piece, one an edge.
/// \return edges of those for which it holds, whose flags are taken
template <class Drops>
Index drop_pieces(TriMesh& mesh, const Drops& drops) {
  std::vector<std::uint8_t> seen(mesh.halfedge_count(), 0);
  Index dropped = 0;
  std::vector<Index> piece;
  for (Index seed = 0; seed < mesh.halfedge_count(); ++seed) {
    if (mesh.is_feature[seed] == 0 || seen[seed] != 0) continue;
    piece.assign(1, seed);
    seen[seed] = seen[mesh.twin[seed]] = 1;
    for (std::size_t i = 0; i < piece.size(); ++i) {
      for (const Index v : {mesh.from(piece[i]), mesh.to(piece[i])}) {
        for_each_outgoing(mesh, v, [&](Index h) {
          if (mesh.is_feature[h] == 0 || seen[h] != 0) return;
          seen[h] = seen[mesh.twin[h]] = 1;
          piece.push_back(h);
        });
      }
    }
    if (!drops(piece)) continue;
    for (const Index h : piece) set_feature(mesh, h, false);
    dropped += static_cast<Index>(piece.size());
  }
  return dropped;
}

/// Takes the flags off connected pieces too short to be features.
Index drop_short_pieces(TriMesh& mesh) {
  const std::vector<Index> degree = barrier_degrees(mesh);
  return drop_pieces(mesh, [&](const std::vector<Index>& piece) {
    double length = 0;
    bool is_simple_loop = true;
    bool meets_boundary = false;
    for (const Index h : piece) {
      length += edge_vector(mesh, h).norm();
      for (const Index v : {mesh.from(h), mesh.to(h)}) {
        is_simple_loop = is_simple_loop && degree[v] == 2;
        meets_boundary = meets_boundary || mesh.is_boundary(mesh.vertex_out[v]);
      }
    }
    return length < kShortestFeature * mesh.diagonal && !is_simple_loop && !meets_boundary;
  });
}

/// Edges of a piece, at most, that may be a lump of noise, where the ground is not rough.
constexpr std::size_t kLargestLump = 40;
/// Share of the bends in a lump that is left of their sum, at most, and of those around it.
struct MostLeft {
  double own = 0.3;
  double around = 0.35;
};
/// The same of a mesh that is rough as a whole: of a few edges that noise bent at random more is
/// left than of many.
constexpr MostLeft kMostLeftOfNoise = {0.9, 0.5};
/// Mean bend around it, at least, and share of the edges there that are bent at all: on a designed
/// part, where walls may be bent both ways, some are in flats.
constexpr double kLeastAround = 1 * kDegree;
/// Mean bend around larger pieces, at least: 17 to 29 degrees around those of a noisy scan, and at
/// most 14.5, where bends cancel, around those of any other of 306 models.
constexpr double kLeastAroundLarge = 15 * kDegree;
constexpr double kNoBend = 0.3 * kDegree;
constexpr double kMostFlat = 0.2;

/// Sums of bends over edges, weighted with their lengths.
struct BendSum {
  double sum = 0;
  double size = 0;
  double length = 0;
  double flat = 0;  ///< of the length

  void add(const TriMesh& mesh, Index h) {
    const Index twin = mesh.twin[h];
    if (twin == kNone) return;
    const Vec3 left = face_cross(mesh, TriMesh::face_of(h));
    const Vec3 right = face_cross(mesh, TriMesh::face_of(twin));
    const Vec3 along = edge_vector(mesh, h);
    const double way = along.norm();
    if (!(way > 0)) return;
    const double bend = std::atan2(left.cross(right).dot(along) / way, left.dot(right));
    sum += way * bend;
    size += way * std::abs(bend);
    length += way;
    if (std::abs(bend) < kNoBend) flat += way;
  }
  [[nodiscard]] bool cancels(double most_left) const { return std::abs(sum) < most_left * size; }
};

std::set<Index> vertices_of(const TriMesh& mesh, const std::vector<Index>& piece) {
  std::set<Index> vertices;
  for (const Index h : piece) vertices.insert({mesh.from(h), mesh.to(h)});
  return vertices;
}

/// Of the edges at these vertices that are no features.
BendSum ground_at(const TriMesh& mesh, const std::set<Index>& vertices) {
  std::set<Index> edges;
  for (const Index v : vertices) {
    for_each_outgoing(mesh, v, [&](Index e) {
      if (mesh.is_feature[e] == 0) edges.insert(mesh.edge_of(e));
    });
  }
  BendSum ground;
  for (const Index e : edges) ground.add(mesh, e);
  return ground;
}

/// Takes the flags off small pieces whose edges are bent to and fro, amid edges that are, too.
///
/// Single vertices that noise has moved far have sharp edges around them however fine the rest is.
/// A step or an embossed letter is bent both ways as well, but stands on a surface that is not.
/// Where points lie closer along one direction than noise is high, as along the lines of a scanner,
/// such edges join to large webs; on rough ground pieces of any size go.
Index drop_lumps(TriMesh& mesh) {
  std::optional<MostLeft> most_left;  // as measuring the mesh takes time, when first asked for
  return drop_pieces(mesh, [&](const std::vector<Index>& piece) {
    if (!most_left) most_left = measure_noise(mesh).is_much() ? kMostLeftOfNoise : MostLeft{};
    BendSum own;
    for (const Index h : piece) own.add(mesh, h);
    if (!own.cancels(most_left->own)) return false;
    std::set<Index> around;
    for (const Index v : vertices_of(mesh, piece)) {
      for_each_outgoing(mesh, v, [&](Index out) { around.insert(mesh.to(out)); });
    }
    const BendSum ground = ground_at(mesh, around);
    const double least = piece.size() > kLargestLump ? kLeastAroundLarge : kLeastAround;
    return ground.size > least * ground.length && ground.cancels(most_left->around) &&
           ground.flat < kMostFlat * ground.length;
  });
}

/// Share of the edges of a component that were noise, at least, where what is left may be frayed;
/// where the whole mesh has it any edge will do.
constexpr double kMuchDropped = 0.1;
/// Edges and length, as a share of the diagonal, for each corner of pieces that are, at most; and
/// mean bend around them, at least: in flats corners are designed.
constexpr double kEdgesOfFrayed = 20;
constexpr double kLengthOfFrayed = 0.1;
constexpr double kLeastAroundFrayed = 1 * kDegree;

/// [C] feature half-edges of each component. \param component  [F]
std::vector<double> features_of(const TriMesh& mesh, const std::vector<Index>& component) {
  std::vector<double> count(*std::ranges::max_element(component) + 1, 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    count[component[TriMesh::face_of(h)]] += mesh.is_feature[h];
  }
  return count;
}

/// [C] whether much of what was found in a component was noise, and some of it by the course of its
/// lines: what else goes may be ends and bits of creases that fade out.
/// \param found, lines_left, left  [C] features at first, without lines that were noise, and now
std::vector<std::uint8_t> where_much_was_noise(const std::vector<double>& found,
                                               const std::vector<double>& lines_left,
                                               const std::vector<double>& left) {
  const auto sum = [](const std::vector<double>& counts) {
    return std::accumulate(counts.begin(), counts.end(), 0.0);
  };
  const double least = sum(found) - sum(left) > kMuchDropped * sum(found) ? 0 : kMuchDropped;
  std::vector<std::uint8_t> is_much;
  for (std::size_t c = 0; c < found.size(); ++c) {
    const bool is_enough = found[c] - left[c] > least * found[c];
    is_much.push_back(is_enough && lines_left[c] < found[c] ? 1 : 0);
  }
  return is_much;
}

/// Takes the flags off pieces with many corners in components much of which was noise.
///
/// A crease that runs across the faces instead of along their edges, as in a height field or a
/// surface of a grid of values, is chamfered by faces of all shapes. Of their edges some are bent
/// enough to be found: bits and saws that lines and cells would have to follow.
/// \param component  [F]
/// \param is_rough   [C] 1: such a one
Index drop_frayed(TriMesh& mesh, const std::vector<Index>& component,
                  const std::vector<std::uint8_t>& is_rough) {
  find_corners(mesh);
  return drop_pieces(mesh, [&](const std::vector<Index>& piece) {
    if (is_rough[component[TriMesh::face_of(piece.front())]] == 0) return false;
    const std::set<Index> vertices = vertices_of(mesh, piece);
    const auto corners = static_cast<double>(
        std::ranges::count_if(vertices, [&](Index v) { return mesh.is_corner[v] != 0; }));
    if (static_cast<double>(piece.size()) >= kEdgesOfFrayed * corners) return false;
    double length = 0;
    for (const Index h : piece) length += edge_vector(mesh, h).norm();
    if (length >= kLengthOfFrayed * mesh.diagonal * corners) return false;
    const BendSum ground = ground_at(mesh, vertices);
    return ground.size > kLeastAroundFrayed * ground.length;
  });
}

}  // namespace

Index drop_shorter(TriMesh& mesh, double length) {
  return drop_pieces(mesh, [&](const std::vector<Index>& piece) {
    double sum = 0;
    for (const Index h : piece) sum += edge_vector(mesh, h).norm();
    return sum < length;
  });
}

Index drop_loose(TriMesh& mesh, const std::vector<Index>& degree) {
  std::vector<Index> own(mesh.positions.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) own[mesh.from(h)] += mesh.is_feature[h];
  return drop_pieces(mesh, [&](const std::vector<Index>& piece) {
    int ends = 0;
    bool is_loose = false;
    for (const Index h : piece) {
      for (const Index v : {mesh.from(h), mesh.to(h)}) {
        if (own[v] != 1) continue;
        ++ends;
        is_loose = is_loose || degree[v] == 0;
      }
    }
    return ends < 2 || is_loose;
  });
}

Index drop_noise(TriMesh& mesh, const std::vector<float>& roughness) {
  const std::vector<Index> component = face_components(mesh);
  const std::vector<double> found = features_of(mesh, component);
  Index dropped = 0;
  while (const Index more = NoisyLines(mesh, roughness).drop()) dropped += more;
  const std::vector<double> lines_left = features_of(mesh, component);
  dropped += drop_loose_ends(mesh);
  dropped += drop_short_pieces(mesh);
  dropped += drop_lumps(mesh);
  const std::vector<std::uint8_t> is_rough =
      where_much_was_noise(found, lines_left, features_of(mesh, component));
  dropped += drop_frayed(mesh, component, is_rough);
  return dropped;
}

}  // namespace strake::import
