#include "stages/import/feature_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/geometry/angles.h"

namespace strake::import {
namespace {

constexpr double kWindow = 0.01;       ///< of the diagonal, on each side of a vertex
constexpr double kSmoothBoundary = 3;  ///< least window along a boundary, mean edges
constexpr double kRaggedBoundary =
    10;  ///< the same where single edges turn by 40 degrees on average
constexpr double kLineShare = 1.0 / 12;  ///< largest window on a closed or boundary line
constexpr double kSmallestHole = 0.04;   ///< of the diagonal: length of a boundary with corners

/// A maximal run of feature or boundary edges through vertices where just two of them meet.
struct Line {
  std::vector<Index> vertices;  ///< of a closed line each once
  bool is_closed = false;
  bool is_boundary = false;
};

/// The feature and boundary lines of a mesh.
class Lines {
 public:
  explicit Lines(const TriMesh& mesh)
      : mesh_(mesh), degree_(barrier_degrees(mesh)), ends_(mesh.positions.size(), {kNone, kNone}) {
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      if (!mesh.is_barrier(h) || mesh.edge_of(h) != h) continue;
      add_end(mesh.from(h), mesh.to(h));
      add_end(mesh.to(h), mesh.from(h));
    }
  }

  /// Calls `visit` with every line that has a vertex where two edges meet.
  template <typename Visit>
  void for_each(const Visit& visit) {
    std::vector<std::uint8_t> seen(mesh_.positions.size(), 0);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (degree_[v] != 2 || seen[v] != 0) continue;
      Line line = trace(v);
      for (const Index u : line.vertices) seen[u] = 1;
      line.is_boundary = mesh_.is_boundary(mesh_.vertex_out[v]);
      visit(line);
    }
  }

 private:
  void add_end(Index at, Index other) {
    if (degree_[at] == 2) ends_[at][ends_[at][0] == kNone ? 0 : 1] = other;
  }

  [[nodiscard]] Line trace(Index seed) const {
    Line line;
    line.vertices = run_from(seed, ends_[seed][0]);
    if (line.vertices.back() == seed && line.vertices.size() > 1) {
      line.is_closed = true;
      line.vertices.pop_back();
      return line;
    }
    std::reverse(line.vertices.begin(), line.vertices.end());
    const std::vector<Index> rest = run_from(seed, ends_[seed][1]);
    line.vertices.insert(line.vertices.end(), rest.begin() + 1, rest.end());
    return line;
  }

  /// Vertices from `seed` by way of `second` to a node, or back to the seed.
  [[nodiscard]] std::vector<Index> run_from(Index seed, Index second) const {
    std::vector<Index> vertices = {seed, second};
    while (vertices.back() != seed && degree_[vertices.back()] == 2) {
      const auto& ends = ends_[vertices.back()];
      const Index before = vertices[vertices.size() - 2];
      vertices.push_back(ends[0] == before ? ends[1] : ends[0]);
    }
    return vertices;
  }

  const TriMesh& mesh_;
  std::vector<Index> degree_;
  std::vector<std::array<Index, 2>> ends_;  ///< other ends of the two edges at vertices of degree 2
};

/// Measures how sharply a line turns, over a distance that looks past ragged edges.
class TurnMeter {
 public:
  TurnMeter(const TriMesh& mesh, const Line& line)
      : mesh_(mesh), line_(line), count_(static_cast<Index>(line.vertices.size())) {
    for (Index i = 0; i + 1 < count_ + (line.is_closed ? 1 : 0); ++i) {
      length_ += (at(i + 1) - at(i)).norm();
    }
    window_ = kWindow * mesh.diagonal;
    if (line.is_boundary) window_ = std::max(window_, ragged_edges() * length_ / count_);
    if (line.is_closed || line.is_boundary) window_ = std::min(window_, kLineShare * length_);
  }

  [[nodiscard]] bool can_have_corners() const {
    return !(line_.is_closed && line_.is_boundary && length_ < kSmallestHole * mesh_.diagonal);
  }

  /// The numbers of the vertices at which the line turns sharply, and more than nearby.
  [[nodiscard]] std::vector<Index> sharp_turns() const {
    std::vector<double> turns(count_, 0);
    const Index inset = line_.is_closed ? 0 : 1;
    for (Index i = inset; i < count_ - inset; ++i) turns[i] = turn(i);
    std::vector<Index> result;
    for (Index i = inset; i < count_ - inset; ++i) {
      if (turns[i] > kSharpTurn && is_sharpest(turns, i, 1) && is_sharpest(turns, i, -1)) {
        result.push_back(i);
      }
    }
    return result;
  }

 private:
  [[nodiscard]] Index wrap(Index i) const { return ((i % count_) + count_) % count_; }
  [[nodiscard]] const Vec3& at(Index i) const {
    return mesh_.positions[line_.vertices[line_.is_closed ? wrap(i) : i]];
  }
  [[nodiscard]] bool is_on_line(Index i) const { return line_.is_closed || (i >= 0 && i < count_); }

  /// From vertex i to the point one window along the line, or to its end.
  [[nodiscard]] Vec3 chord(Index i, Index step) const {
    double left = window_;
    Index j = i;
    for (Index n = 0; n < count_ && is_on_line(j + step); ++n, j += step) {
      const double edge = (at(j + step) - at(j)).norm();
      if (edge >= left) {
        return at(j) + (left / std::max(edge, 1e-300)) * (at(j + step) - at(j)) - at(i);
      }
      left -= edge;
    }
    return at(j) - at(i);
  }

  /// Edges to look past along a boundary: the more, the more it turns from edge to edge.
  [[nodiscard]] double ragged_edges() const {
    constexpr double kRagged = 40 * kDegree;
    const Index inset = line_.is_closed ? 0 : 1;
    double sum = 0;
    for (Index i = inset; i < count_ - inset; ++i) {
      sum += angle_between(at(i) - at(i - 1), at(i + 1) - at(i));
    }
    const double mean = sum / std::max(count_ - 2 * inset, 1);
    return std::clamp(kRaggedBoundary * mean / kRagged, kSmoothBoundary, kRaggedBoundary);
  }

  [[nodiscard]] double turn(Index i) const { return angle_between(-chord(i, -1), chord(i, 1)); }

  /// Whether no vertex within a window on one side turns more; of equals the first on the line.
  [[nodiscard]] bool is_sharpest(const std::vector<double>& turns, Index i, Index step) const {
    double left = window_;
    for (Index n = 1; n < count_ && is_on_line(i + n * step); ++n) {
      left -= (at(i + n * step) - at(i + (n - 1) * step)).norm();
      if (left < 0) return true;
      const Index j = line_.is_closed ? wrap(i + n * step) : i + n * step;
      const bool is_before = j < i;
      if (turns[j] > turns[i] || (turns[j] == turns[i] && is_before)) return false;
    }
    return true;
  }

  const TriMesh& mesh_;
  const Line& line_;
  Index count_ = 0;
  double length_ = 0;
  double window_ = 0;
};

}  // namespace

std::vector<Index> barrier_degrees(const TriMesh& mesh) {
  std::vector<Index> degree(mesh.positions.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_barrier(h) || mesh.edge_of(h) != h) continue;
    ++degree[mesh.from(h)];
    ++degree[mesh.to(h)];
  }
  return degree;
}

Index find_corners(TriMesh& mesh) {
  const std::vector<Index> degree = barrier_degrees(mesh);
  mesh.is_corner.assign(mesh.positions.size(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    mesh.is_corner[v] = degree[v] != 0 && degree[v] != 2 ? 1 : 0;
  }
  Lines(mesh).for_each([&](const Line& line) {
    const TurnMeter meter(mesh, line);
    if (!meter.can_have_corners()) return;
    for (const Index i : meter.sharp_turns()) mesh.is_corner[line.vertices[i]] = 1;
  });
  return static_cast<Index>(std::count(mesh.is_corner.begin(), mesh.is_corner.end(), 1));
}

}  // namespace strake::import
