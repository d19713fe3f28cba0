#include "stages/fit/even_flats.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "common/geometry/poly_topology/vertex_faces.h"

namespace strake::fitting {
namespace {

constexpr int kMostSweeps = 40;
constexpr double kMoved = 0.005;  ///< share of the shortest edge; less is no reason to go on
/// Shares of the way that are tried: too far first, which evens out long rows in fewer sweeps.
constexpr std::array<double, 4> kSteps = {1.5, 1, 0.5, 0.25};
/// Times that it counts that an edge has its direction, in the sweeps after those for evenness
/// alone: lines that are held straight from the start move as wholes, which takes far more sweeps.
constexpr double kAcross = 10;
constexpr double kNear = 0.87;  ///< cosine of the angle up to which an edge belongs to an arm
/// Evenness of a corner from which on it may get worse.
constexpr double kEvenEnough = 0.5;
constexpr double kSameEvenness = 1e-9;  ///< rounding
/// Cosine of the angle between normals of the surface where it is flat.
constexpr double kParallel = 0.9999;

class EvenFlats {
 public:
  EvenFlats(const PolyMesh& mesh, const PrincipalField* field, double off,
            const VertexPlaces& places)
      : mesh_(mesh),
        places_(places),
        around_(mesh),
        positions_(places.positions()),
        arms_(positions_.size(), Vec3::Zero()) {
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (!is_inside_flat(v, off)) continue;
      inside_.push_back({v, {}});
      if (field != nullptr) arms_[v] = places.cross_arm(*field, v);
    }
    for (auto& [v, edges] : inside_) {
      for (const Index w : around_.neighbours(v)) edges.push_back({w, direction(v, w)});
    }
  }

  /// [V] places of all vertices at the end.
  std::vector<Vec3> run() {
    for (const double across : {1.0, kAcross}) {
      across_ = across;
      sweep();
    }
    return std::move(positions_);
  }

 private:
  struct Edge {
    Index to = kNone;
    Vec3 along = Vec3::Zero();  ///< see `direction`
  };
  struct Inside {
    Index vertex = kNone;
    std::vector<Edge> edges;
  };

  void sweep() {
    std::vector<std::uint8_t> is_due(positions_.size(), 1);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
      bool is_moved = false;
      for (const auto& [v, edges] : inside_) {
        if (is_due[v] == 0) continue;
        is_due[v] = 0;
        if (!move(v, edges)) continue;
        is_moved = true;
        is_due[v] = 1;
        for (const auto& [w, along] : edges) is_due[w] = 1;
      }
      if (!is_moved) break;
    }
  }

  [[nodiscard]] bool is_inside_flat(Index v, double off) const {
    if (!places_.is_free(v)) return false;
    const Vec3& normal = places_.normal(v);
    for (const Index f : around_.faces(v)) {
      for (const Index w : mesh_.face(f)) {
        if (!(std::abs((positions_[w] - positions_[v]).dot(normal)) <= off)) return false;
        if (places_.is_free(w) && places_.normal(w).dot(normal) < kParallel) return false;
      }
    }
    return true;
  }

  /// How even the corners of the faces around a vertex are: each the angle as a share of that in a
  /// regular face, or what it lacks to a straight one, whichever is less; at most 0 where it is not
  /// convex.
  void corners_around(Index v, std::vector<double>& corners) const {
    const Vec3& normal = places_.normal(v);
    corners.clear();
    for (const Index f : around_.faces(v)) {
      const std::span<const Index> face = mesh_.face(f);
      const std::size_t n = face.size();
      const double regular = std::numbers::pi * (1 - 2 / static_cast<double>(n));
      for (std::size_t i = 0; i < n; ++i) {
        const Vec3 ahead = positions_[face[(i + 1) % n]] - positions_[face[i]];
        const Vec3 back = positions_[face[(i + n - 1) % n]] - positions_[face[i]];
        double angle = std::atan2(ahead.cross(back).dot(normal), ahead.dot(back));
        if (angle < -std::numbers::pi / 2) angle += 2 * std::numbers::pi;
        corners.push_back(
            std::min(angle / regular, (std::numbers::pi - angle) / (std::numbers::pi - regular)));
      }
    }
  }

  /// The direction that an edge from v should have: the arm of the crosses at its ends that it is
  /// near to, unit; zero where it is near to none.
  [[nodiscard]] Vec3 direction(Index v, Index w) const {
    const Vec3& normal = places_.normal(v);
    const Vec3 edge = positions_[w] - positions_[v];
    const auto nearest = [&](const Vec3& arm) {
      const Vec3 side = normal.cross(arm);
      const double along = edge.dot(arm);
      const double across = edge.dot(side);
      if (std::abs(along) >= std::abs(across)) return Vec3(along < 0 ? -arm : arm);
      return Vec3(across < 0 ? -side : side);
    };
    const Vec3 between = nearest(arms_[v]) + nearest(arms_[w]);
    const double length = between.norm();
    if (!(length > 0) || between.dot(edge) < kNear * length * edge.norm()) return Vec3::Zero();
    return between / length;
  }

  bool move(Index v, const std::vector<Edge>& edges) {
    const Vec3 old = positions_[v];
    const Vec3& normal = places_.normal(v);
    Mat3 weights = normal * normal.transpose();  // it goes nowhere along that
    Vec3 sum = Vec3::Zero();
    double shortest = std::numeric_limits<double>::infinity();
    for (const auto& [w, along] : edges) {
      const Vec3 edge = positions_[w] - old;
      shortest = std::min(shortest, edge.norm());
      Mat3 weight = Mat3::Identity();
      if (!along.isZero(0)) weight += (across_ - 1) * (weight - along * along.transpose());
      weights += weight;
      sum += weight * edge;
    }
    Vec3 way = weights.llt().solve(sum);
    way -= way.dot(normal) * normal;
    corners_around(v, before_);
    for (const double step : kSteps) {
      if (!(step * way.norm() > kMoved * shortest)) break;
      positions_[v] = old + step * way;
      corners_around(v, after_);
      if (!is_worse()) return true;
    }
    positions_[v] = old;
    return false;
  }

  [[nodiscard]] bool is_worse() const {
    for (std::size_t i = 0; i < before_.size(); ++i) {
      if (after_[i] < std::min(before_[i], kEvenEnough) - kSameEvenness) return true;
    }
    return false;
  }

  const PolyMesh& mesh_;
  const VertexPlaces& places_;
  VertexFaces around_;
  std::vector<Vec3> positions_;  ///< [V]
  std::vector<Vec3> arms_;       ///< [V] of the cross at vertices inside; zero elsewhere
  std::vector<Inside> inside_;   ///< by their vertex, ascending
  double across_ = 1;
  std::vector<double> before_;
  std::vector<double> after_;
};

}  // namespace

Index even_flats(const PolyMesh& mesh, const PrincipalField* field, double off,
                 VertexPlaces& places) {
  const std::vector<Vec3> even = EvenFlats(mesh, field, off, places).run();
  Index moved = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (even[v] == places.positions()[v]) continue;
    places.move(v, even[v] - places.positions()[v]);
    ++moved;
  }
  return moved;
}

}  // namespace strake::fitting
