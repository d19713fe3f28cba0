#include "stages/import/noise.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/geometry/frames.h"

namespace strake::import {
namespace {

/// Of the bench's scans the roughest has 11 degrees and 0.64, and a coarse control mesh 20 and
/// 0.59; with noise of a fifth of the edges' length a scan has 25 and 0.85.
constexpr double kMuchBend = 20;
constexpr double kMuchToAndFro = 0.75;
/// Threads and twisted extrusions have 0.98, noisy scans below 0.001.
constexpr double kRegular = 0.5;
/// Bend in degrees from which on an edge is looked at, and share by which bends and lengths of
/// edges that repeat each other differ.
constexpr double kBent = 1;
constexpr double kAlike = 0.1;
constexpr std::size_t kBinsPerDegree = 10;
/// Share of the second difference that a round takes: nothing oscillates below a half.
constexpr double kRate = 0.3;
/// Share of the diagonal below which edges count as this long.
constexpr double kShortest = 1e-9;

/// Bends of inner edges between faces with an area, positive where the surface is convex.
struct Bends {
  explicit Bends(const TriMesh& mesh) : mesh_(mesh), area_normals_(mesh.faces.size()) {
    for (Index f = 0; f < mesh.face_count(); ++f) area_normals_[f] = face_cross(mesh, f);
  }

  /// Calls use(half-edge, bend in degrees, length) for each edge, in order. Bends, which take most
  /// of the time, are computed on all threads, some at a time.
  template <class Use>
  void for_each(const Use& use) const {
    std::vector<Bend> block(std::min(kAtATime, mesh_.halfedge_count()));
    for (Index first = 0; first < mesh_.halfedge_count(); first += kAtATime) {
      const Index count = std::min(kAtATime, mesh_.halfedge_count() - first);
      tbb::parallel_for(Index{0}, count, [&](Index i) { block[i] = bend_at(first + i); });
      for (Index i = 0; i < count; ++i) {
        if (block[i].length > 0) use(first + i, block[i].degrees, block[i].length);
      }
    }
  }

  /// Calls use(half-edge) for the same edges.
  template <class Use>
  void for_each_edge(const Use& use) const {
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (length_at(h) > 0) use(h);
    }
  }

 private:
  static constexpr Index kAtATime = 1 << 16;

  struct Bend {
    double degrees = 0;
    double length = 0;  ///< 0: that of no edge
  };

  [[nodiscard]] const Vec3& area_normal(Index h) const {
    return area_normals_[TriMesh::face_of(h)];
  }
  [[nodiscard]] Vec3 along(Index h) const {
    return mesh_.positions[mesh_.to(h)] - mesh_.positions[mesh_.from(h)];
  }
  /// 0 where `h` is not the first half-edge of an inner edge between faces with an area.
  [[nodiscard]] double length_at(Index h) const {
    const Index twin = mesh_.twin[h];
    if (twin == kNone || h > twin) return 0;
    const bool have_area = area_normal(h).norm() > 0 && area_normal(twin).norm() > 0;
    return have_area ? along(h).norm() : 0;
  }
  [[nodiscard]] Bend bend_at(Index h) const {
    const double length = length_at(h);
    if (!(length > 0)) return {};
    const Vec3& left = area_normal(h);
    const Vec3& right = area_normal(mesh_.twin[h]);
    const double bend = std::atan2(left.cross(right).dot(along(h)) / length, left.dot(right));
    return {bend * 180 / std::numbers::pi, length};
  }

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
  bends.for_each_edge([&](Index h) {
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

/// How much of what is bent repeats: translates of an edge are those opposite of it in the
/// parallelograms of two triangles on either side, and those that run on straight at its ends where
/// six edges meet there.
class Repetition {
 public:
  Repetition(const TriMesh& mesh, const Bends& bends)
      : mesh_(mesh), bend_(mesh.twin.size(), 0), length_(mesh.twin.size(), 0) {
    bends.for_each([&](Index h, double bend, double length) {
      for (const Index side : {h, mesh.twin[h]}) {
        bend_[side] = bend;
        length_[side] = length;
      }
    });
  }

  [[nodiscard]] double share() const {
    double bent = 0;
    double repeated = 0;
    for (Index h = 0; h < mesh_.halfedge_count(); ++h) {
      if (mesh_.twin[h] == kNone || h > mesh_.twin[h] || std::abs(bend_[h]) < kBent) continue;
      bent += length_[h];
      if (is_repeated(h)) repeated += length_[h];
    }
    return bent > 0 ? repeated / bent : 0;
  }

 private:
  [[nodiscard]] bool is_repeated(Index h) const {
    const Index twin = mesh_.twin[h];
    return (is_alike(h, beyond_next(h)) && is_alike(h, beyond_next(twin))) ||
           (is_alike(h, beyond_prev(h)) && is_alike(h, beyond_prev(twin))) ||
           (is_alike(h, straight_on(h)) && is_alike(h, straight_on(twin)));
  }

  [[nodiscard]] bool is_alike(Index h, Index other) const {
    return other != kNone && std::abs(bend_[other] - bend_[h]) <= kAlike * std::abs(bend_[h]) &&
           std::abs(length_[other] - length_[h]) <= kAlike * length_[h];
  }

  [[nodiscard]] Index beyond_next(Index h) const {
    const Index over = mesh_.twin[TriMesh::next(h)];
    return over == kNone ? kNone : TriMesh::prev(over);
  }
  [[nodiscard]] Index beyond_prev(Index h) const {
    const Index over = mesh_.twin[TriMesh::prev(h)];
    return over == kNone ? kNone : TriMesh::next(over);
  }
  [[nodiscard]] Index straight_on(Index h) const {
    Index on = TriMesh::next(h);
    for (int edges = 0; edges < 2; ++edges) {
      if (mesh_.twin[on] == kNone) return kNone;
      on = TriMesh::next(mesh_.twin[on]);
    }
    return on;
  }

  const TriMesh& mesh_;
  std::vector<double> bend_;    ///< [3F] degrees
  std::vector<double> length_;  ///< [3F] 0 on the boundary
};

/// What a vertex lies on; vertices are compared with others of their kind.
enum class Kind : std::uint8_t { face, crease, boundary, held };

/// [V] Corners and ends of creases are held, at the boundary, too, and tips of cones.
std::vector<Kind> kinds_of_vertices(const TriMesh& mesh) {
  std::vector<int> creases(mesh.positions.size(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_feature[h] != 0) ++creases[mesh.from(h)];
  }
  std::vector<Kind> kinds(mesh.positions.size(), Kind::face);
  for (std::size_t v = 0; v < kinds.size(); ++v) {
    if (creases[v] == 0 && mesh.is_corner[v] == 0) continue;
    kinds[v] = creases[v] == 2 && mesh.is_corner[v] == 0 ? Kind::crease : Kind::held;
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    for (const Index v : {mesh.from(h), mesh.to(h)}) {
      kinds[v] = creases[v] == 0 ? Kind::boundary : Kind::held;
    }
  }
  return kinds;
}

/// [V] unit normals of the vertices, by the areas of their faces.
std::vector<Vec3> vertex_normals(const TriMesh& mesh) {
  std::vector<Vec3> normals(mesh.positions.size(), Vec3::Zero());
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const Vec3 area = face_cross(mesh, f);
    for (const Index v : mesh.faces[f]) normals[v] += area;
  }
  for (Vec3& n : normals) n.normalize();
  return normals;
}

/// A neighbour that counts for the middle of a vertex.
struct Arm {
  Index at = 0;
  Index to = 0;
  double share = 0;  ///< of all arms of the vertex
  /// Of what both ends are off their middles in the comparison; 0 where they are not compared.
  double here = 0;
  double there = 0;
};

std::vector<Arm> arms_of(const TriMesh& mesh, const std::vector<Kind>& kinds) {
  std::vector<Arm> arms;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index a = mesh.from(h);
    const Index b = mesh.to(h);
    const bool is_crease = mesh.is_feature[h] != 0;
    if (kinds[a] == Kind::face || (kinds[a] == Kind::crease && is_crease)) arms.push_back({a, b});
    if (!mesh.is_boundary(h)) continue;
    if (kinds[a] == Kind::boundary) arms.push_back({a, b});
    if (kinds[b] == Kind::boundary) arms.push_back({b, a});
  }
  return arms;
}

/// Fills in shares and scales from lengths of edges.
void weigh(const TriMesh& mesh, const std::vector<Kind>& kinds, std::vector<Arm>& arms) {
  std::vector<double> sum(mesh.positions.size(), 0);
  std::vector<double> count(mesh.positions.size(), 0);
  for (Arm& arm : arms) {
    const double length = (mesh.positions[arm.to] - mesh.positions[arm.at]).norm();
    arm.share = 1 / std::max(length, kShortest * mesh.diagonal);
    sum[arm.at] += arm.share;
    count[arm.at] += 1;
  }
  for (Arm& arm : arms) {
    arm.share /= sum[arm.at];
    if (kinds[arm.at] != kinds[arm.to]) continue;
    const double here = count[arm.at] / sum[arm.at];
    const double there = count[arm.to] / sum[arm.to];
    arm.here = std::min(here, there) / here;
    arm.there = std::min(here, there) / there;
  }
}

/// Moves the vertices of a mesh once.
void smooth(TriMesh& mesh, const std::vector<Kind>& kinds, const std::vector<Arm>& arms) {
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const auto keep_to_normals = [&](std::vector<Vec3>& vectors) {
    for (std::size_t v = 0; v < vectors.size(); ++v) {
      if (kinds[v] == Kind::boundary) vectors[v] = vectors[v].dot(normals[v]) * normals[v];
    }
  };
  std::vector<Vec3> off(kinds.size(), Vec3::Zero());
  for (const Arm& arm : arms) {
    off[arm.at] += arm.share * (mesh.positions[arm.to] - mesh.positions[arm.at]);
  }
  keep_to_normals(off);
  std::vector<Vec3> move(kinds.size(), Vec3::Zero());
  for (const Arm& arm : arms) {
    move[arm.at] += arm.share * (arm.here * off[arm.at] - arm.there * off[arm.to]);
  }
  keep_to_normals(move);
  for (std::size_t v = 0; v < move.size(); ++v) mesh.positions[v] += kRate * move[v];
}

}  // namespace

bool Noise::is_much() const {
  return median_bend_deg > kMuchBend && to_and_fro > kMuchToAndFro && repeated < kRegular;
}

Noise measure_noise(const TriMesh& mesh) {
  const Bends bends(mesh);
  Noise noise;
  noise.median_bend_deg = median_bend(bends);
  if (noise.median_bend_deg > 0) noise.to_and_fro = to_and_fro(mesh, bends);
  if (noise.is_much()) noise.repeated = Repetition(mesh, bends).share();
  return noise;
}

Moves take_noise_off(TriMesh& mesh, std::int64_t rounds) {
  const std::vector<Vec3> before = mesh.positions;
  const std::vector<Vec3> normals = vertex_normals(mesh);
  const std::vector<Kind> kinds = kinds_of_vertices(mesh);
  std::vector<Arm> arms = arms_of(mesh, kinds);
  weigh(mesh, kinds, arms);
  for (std::int64_t round = 0; round < rounds; ++round) smooth(mesh, kinds, arms);
  Moves moves;
  double squares = 0;
  for (std::size_t v = 0; v < before.size(); ++v) {
    const double way = std::abs((mesh.positions[v] - before[v]).dot(normals[v]));
    squares += way * way;
    moves.largest = std::max(moves.largest, way);
  }
  moves.rms = std::sqrt(squares / static_cast<double>(before.size()));
  return moves;
}

}  // namespace strake::import
