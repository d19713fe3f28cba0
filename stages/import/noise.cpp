#include "stages/import/noise.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace strake::import {
namespace {

/// Of the bench's scans the roughest has 11 degrees and 0.64, and a coarse control mesh 20 and
/// 0.59; with noise of a fifth of the edges' length a scan has 25 and 0.85.
constexpr double kMuchBend = 20;
constexpr double kMuchToAndFro = 0.75;
constexpr std::size_t kBinsPerDegree = 10;
/// Taubin's factors: what is longer than about twenty edges stays.
constexpr double kForth = 0.5;
constexpr double kBack = -0.53;

/// Bends of edges, positive where the surface is convex.
struct Bends {
  explicit Bends(const TriMesh& mesh) : mesh_(mesh), area_normals_(mesh.faces.size()) {
    for (std::size_t f = 0; f < area_normals_.size(); ++f) {
      const auto& [a, b, c] = mesh.faces[f];
      area_normals_[f] =
          (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    }
  }

  /// Calls use(half-edge, bend in degrees, length) for each inner edge.
  template <class Use>
  void for_each(const Use& use) const {
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      const Index twin = mesh_.twin[h];
      if (twin == kNone || h > twin) continue;
      const Vec3& left = area_normals_[TriMesh::face_of(h)];
      const Vec3& right = area_normals_[TriMesh::face_of(twin)];
      const Vec3 along = mesh_.positions[mesh_.to(h)] - mesh_.positions[mesh_.from(h)];
      const double length = along.norm();
      if (!(length > 0) || !(left.norm() > 0) || !(right.norm() > 0)) continue;
      const double bend = std::atan2(left.cross(right).dot(along) / length, left.dot(right)) * 180 /
                          std::numbers::pi;
      use(h, bend, length);
    }
  }

 private:
  const TriMesh& mesh_;
  std::vector<Vec3> area_normals_;
};

double median_bend(const Bends& bends) {
  std::vector<double> lengths(180 * kBinsPerDegree + 1, 0);
  double total = 0;
  bends.for_each([&](Index, double bend, double length) {
    lengths[static_cast<std::size_t>(std::abs(bend) * kBinsPerDegree)] += length;
    total += length;
  });
  double below = 0;
  for (std::size_t bin = 0; bin < lengths.size(); ++bin) {
    below += lengths[bin];
    if (2 * below >= total) return static_cast<double>(bin) / kBinsPerDegree;
  }
  return 0;
}

double to_and_fro(const TriMesh& mesh, const Bends& bends) {
  const std::size_t vertices = mesh.positions.size();
  std::vector<double> sum(vertices, 0);
  double all = 0;
  std::vector<double> size(vertices, 0);
  bends.for_each([&](Index h, double bend, double length) {
    for (const Index v : {mesh.from(h), mesh.to(h)}) {
      sum[v] += bend * length;
      size[v] += std::abs(bend) * length;
    }
  });
  std::vector<double> around(vertices, 0);
  bends.for_each([&](Index h, double, double) {
    const Index a = mesh.from(h);
    const Index b = mesh.to(h);
    around[a] += sum[b];
    around[b] += sum[a];
    all += size[a] + size[b];
  });
  double left = 0;
  for (const double s : around) left += std::abs(s);
  return all > 0 ? 1 - left / all : 0;
}

/// [V] 1 at the boundary.
std::vector<std::uint8_t> boundary_vertices(const TriMesh& mesh) {
  std::vector<std::uint8_t> at_boundary(mesh.positions.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) at_boundary[mesh.from(h)] = at_boundary[mesh.to(h)] = 1;
  }
  return at_boundary;
}

/// [V] unit normals of the vertices at the boundary, by the areas of their faces.
std::vector<Vec3> boundary_normals(const TriMesh& mesh,
                                   const std::vector<std::uint8_t>& at_boundary) {
  std::vector<Vec3> normal(mesh.positions.size(), Vec3::Zero());
  for (const auto& [a, b, c] : mesh.faces) {
    if (at_boundary[a] == 0 && at_boundary[b] == 0 && at_boundary[c] == 0) continue;
    const Vec3 area =
        (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
    for (const Index v : {a, b, c}) normal[v] += area;
  }
  for (Vec3& n : normal) n.normalize();
  return normal;
}

/// Neighbours that count for the middle of a vertex, pair by pair.
std::vector<std::array<Index, 2>> pairs_of_neighbours(
    const TriMesh& mesh, const std::vector<std::uint8_t>& at_boundary) {
  std::vector<std::array<Index, 2>> pairs;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index a = mesh.from(h);
    const Index b = mesh.to(h);
    if (mesh.is_boundary(h)) {
      pairs.push_back({a, b});
      pairs.push_back({b, a});
    } else if (at_boundary[a] == 0) {
      pairs.push_back({a, b});
    }
  }
  return pairs;
}

}  // namespace

bool Noise::is_much() const { return median_bend_deg > kMuchBend && to_and_fro > kMuchToAndFro; }

Noise measure_noise(const TriMesh& mesh) {
  const Bends bends(mesh);
  Noise noise;
  noise.median_bend_deg = median_bend(bends);
  if (noise.median_bend_deg > 0) noise.to_and_fro = to_and_fro(mesh, bends);
  return noise;
}

double take_noise_off(TriMesh& mesh, std::int64_t rounds) {
  const std::vector<Vec3> before = mesh.positions;
  const std::vector<std::uint8_t> at_boundary = boundary_vertices(mesh);
  const std::vector<std::array<Index, 2>> pairs = pairs_of_neighbours(mesh, at_boundary);
  std::vector<double> count(before.size(), 0);
  for (const auto& [a, b] : pairs) count[a] += 1;
  std::vector<Vec3> sum(before.size());
  for (std::int64_t step = 0; step < 2 * rounds; ++step) {
    std::ranges::fill(sum, Vec3::Zero());
    for (const auto& [a, b] : pairs) sum[a] += mesh.positions[b];
    const double factor = step % 2 == 0 ? kForth : kBack;
    const std::vector<Vec3> normal = boundary_normals(mesh, at_boundary);
    for (std::size_t v = 0; v < sum.size(); ++v) {
      if (!(count[v] > 0)) continue;
      const Vec3 move = factor * (sum[v] / count[v] - mesh.positions[v]);
      mesh.positions[v] += at_boundary[v] == 0 ? move : move.dot(normal[v]) * normal[v];
    }
  }
  double squares = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    squares += (mesh.positions[v] - before[v]).squaredNorm();
  }
  return std::sqrt(squares / static_cast<double>(before.size()));
}

}  // namespace strake::import
