#include "common/geometry/samples/relax.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace strake {
namespace {

/// Smoothing moves a vertex this share of the way to the middle of its neighbours.
constexpr double kStep = 0.7;
/// Moves may not make the worst triangle around worse, unless it stays better than this.
constexpr double kGoodEnough = 0.6;
constexpr double kAcceptable = 0.4;  ///< the same for random displacements
/// New triangles must face along the old surface to within 60 degrees.
constexpr double kFacing = 0.5;
constexpr int kFlipSweeps = 20;        ///< at the end
constexpr int kFlipSweepsBetween = 2;  ///< before each round of smoothing

/// 1 for an equilateral triangle, 0 for a degenerate one.
double shape(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double squares = (b - a).squaredNorm() + (c - b).squaredNorm() + (a - c).squaredNorm();
  return 2 * std::sqrt(3.0) * (b - a).cross(c - a).norm() / squares;
}

/// Whether the angles at c and d over the edge ab add up to more than half a turn: the sine of the
/// sum is then negative.
bool is_beyond_delaunay(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const double cos_c = (a - c).dot(b - c), cos_d = (a - d).dot(b - d);
  if (cos_c >= 0 && cos_d >= 0) return false;
  const double sin_c = (a - c).cross(b - c).norm(), sin_d = (a - d).cross(b - d).norm();
  const double lengths = (a - c).norm() * (b - c).norm() * (a - d).norm() * (b - d).norm();
  return sin_c * cos_d + cos_c * sin_d < -1e-9 * lengths;
}

/// Half-edge view of a draft: half-edge 3 f + i runs from corner i of face f to the next.
class Relaxer {
 public:
  explicit Relaxer(SurfaceDraft& draft) : draft_(draft) { connect(); }

  void flip_to_delaunay(int sweeps) {
    for (int sweep = 0; sweep < sweeps; ++sweep) {
      bool changed = false;
      for (Index h = 0; h < static_cast<Index>(twin_.size()); ++h) {
        if (h < twin_[h] && !locked_[h] && wants_flip(h)) {
          flip(h);
          changed = true;
        }
      }
      if (!changed) break;
    }
  }

  void smooth() {
    for (Index v = 0; v < static_cast<Index>(draft_.positions.size()); ++v) {
      if (draft_.vertex_surface[v] == nullptr) continue;
      collect_fan(v);
      Vec3 middle = Vec3::Zero();
      for (const Index h : fan_) middle += at(to(h));
      middle /= static_cast<double>(fan_.size());
      try_move(v, at(v) + kStep * (middle - at(v)), kGoodEnough);
    }
  }

  void scatter(double amount, UniformRandom& random) {
    for (Index v = 0; v < static_cast<Index>(draft_.positions.size()); ++v) {
      const Vec3 direction = random.in_cube();
      if (draft_.vertex_surface[v] == nullptr) continue;
      collect_fan(v);
      double shortest = (at(to(fan_[0])) - at(v)).norm();
      for (const Index h : fan_) shortest = std::min(shortest, (at(to(h)) - at(v)).norm());
      const Vec3 normal = draft_.vertex_surface[v]->normal(at(v));
      const Vec3 tangential = direction - direction.dot(normal) * normal;
      // Where all of it would spoil a triangle, a part of it may do.
      for (const double share : {1.0, 0.5, 0.25}) {
        if (try_move(v, at(v) + share * amount * shortest * tangential, kAcceptable)) break;
      }
    }
  }

 private:
  static Index next(Index h) { return h % 3 == 2 ? h - 2 : h + 1; }
  static Index prev(Index h) { return h % 3 == 0 ? h + 2 : h - 1; }
  [[nodiscard]] Index from(Index h) const { return draft_.faces[h / 3][h % 3]; }
  [[nodiscard]] Index to(Index h) const { return from(next(h)); }
  [[nodiscard]] const Vec3& at(Index v) const { return draft_.positions[v]; }

  void connect() {
    const Index count = 3 * static_cast<Index>(draft_.faces.size());
    twin_.assign(count, kNone);
    locked_.assign(count, 0);
    out_.assign(draft_.positions.size(), kNone);
    std::vector<std::array<Index, 3>> edges;  // smaller vertex, larger vertex, half-edge
    edges.reserve(count);
    for (Index h = 0; h < count; ++h) {
      edges.push_back({std::min(from(h), to(h)), std::max(from(h), to(h)), h});
      out_[from(h)] = h;
    }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0; i < edges.size(); ++i) {
      const std::array<Index, 2> ends = {edges[i][0], edges[i][1]};
      locked_[edges[i][2]] =
          std::binary_search(draft_.locked.begin(), draft_.locked.end(), ends) ? 1 : 0;
      if (i + 1 < edges.size() && edges[i + 1][0] == ends[0] && edges[i + 1][1] == ends[1]) {
        twin_[edges[i][2]] = edges[i + 1][2];
        twin_[edges[i + 1][2]] = edges[i][2];
      }
    }
  }

  /// Outgoing half-edges around a vertex.
  void collect_fan(Index v) {
    fan_.clear();
    const Index first = out_[v];
    Index h = first;
    do {
      fan_.push_back(h);
      h = twin_[prev(h)];
    } while (h != kNone && h != first);
    if (h == first) return;
    // A boundary: the rest lies clockwise of where the walk began.
    for (h = twin_[first]; h != kNone; h = twin_[next(h)]) fan_.push_back(next(h));
  }

  bool try_move(Index v, const Vec3& wish, double good_enough) {
    const ChartedSurface& surface = *draft_.vertex_surface[v];
    const Vec3 p = surface.project(wish);
    const Vec3 normal = surface.normal(p);
    double before = 1, after = 1;
    for (const Index h : fan_) {
      const Vec3 &b = at(to(h)), &c = at(to(next(h)));
      before = std::min(before, shape(at(v), b, c));
      after = std::min(after, shape(p, b, c));
      const Vec3 area = (b - p).cross(c - p);
      if (area.dot(normal) < kFacing * area.norm()) return false;
    }
    if (after < std::min(before, good_enough)) return false;
    draft_.positions[v] = p;
    return true;
  }

  [[nodiscard]] bool connected(Index a, Index b) {
    collect_fan(a);
    return std::any_of(fan_.begin(), fan_.end(),
                       [&](Index h) { return to(h) == b || from(prev(h)) == b; });
  }

  bool wants_flip(Index h) {
    const Index g = twin_[h];
    const Index a = from(h), b = to(h), c = to(next(h)), d = to(next(g));
    if (!is_beyond_delaunay(at(a), at(b), at(c), at(d))) return false;
    const Vec3 old = (at(b) - at(a)).cross(at(c) - at(a)) + (at(d) - at(a)).cross(at(b) - at(a));
    const Vec3 first = (at(a) - at(c)).cross(at(d) - at(c));
    const Vec3 second = (at(d) - at(c)).cross(at(b) - at(c));
    const auto keeps_facing = [&](const Vec3& area) {
      return area.dot(old) > kFacing * area.norm() * old.norm();
    };
    return keeps_facing(first) && keeps_facing(second) && !connected(c, d);
  }

  /// Replaces edge ab of the faces abc and bad by cd: faces cad and cdb.
  void flip(Index h) {
    const Index g = twin_[h];
    const Index a = from(h), b = to(h), c = to(next(h)), d = to(next(g));
    const Index bc = next(h), ca = prev(h), ad = next(g), db = prev(g);
    const Index f0 = h / 3, f1 = g / 3;
    const std::array<Index, 4> outer_twin = {twin_[ca], twin_[ad], twin_[db], twin_[bc]};
    const std::array<std::uint8_t, 4> outer_lock = {locked_[ca], locked_[ad], locked_[db],
                                                    locked_[bc]};
    draft_.faces[f0] = {c, a, d};
    draft_.faces[f1] = {c, d, b};
    const std::array<Index, 4> outer = {3 * f0, 3 * f0 + 1, 3 * f1 + 1, 3 * f1 + 2};
    for (std::size_t i = 0; i < 4; ++i) {
      twin_[outer[i]] = outer_twin[i];
      locked_[outer[i]] = outer_lock[i];
      if (outer_twin[i] != kNone) twin_[outer_twin[i]] = outer[i];
    }
    twin_[3 * f0 + 2] = 3 * f1;
    twin_[3 * f1] = 3 * f0 + 2;
    locked_[3 * f0 + 2] = locked_[3 * f1] = 0;
    out_[c] = 3 * f0;
    out_[a] = 3 * f0 + 1;
    out_[d] = 3 * f0 + 2;
    out_[b] = 3 * f1 + 2;
  }

  SurfaceDraft& draft_;
  std::vector<Index> twin_;
  std::vector<std::uint8_t> locked_;
  std::vector<Index> out_;
  std::vector<Index> fan_;
};

}  // namespace

void relax(SurfaceDraft& draft, int rounds) {
  Relaxer relaxer(draft);
  for (int round = 0; round < rounds; ++round) {
    relaxer.flip_to_delaunay(kFlipSweepsBetween);
    relaxer.smooth();
  }
  relaxer.flip_to_delaunay(kFlipSweeps);
}

void scatter(SurfaceDraft& draft, double amount, UniformRandom& random) {
  Relaxer relaxer(draft);
  relaxer.scatter(amount, random);
  relaxer.flip_to_delaunay(kFlipSweeps);
}

}  // namespace strake
