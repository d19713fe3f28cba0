#include "stages/fit/fit.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake {
namespace {

/// Dunavant's rule of degree 4: exact for the square of a quadratic distance over a triangle.
struct Quadrature {
  double weight;
  std::array<double, 3> at;
};
constexpr double kA = 0.108103018168070;
constexpr double kB = 0.445948490915965;
constexpr double kC = 0.816847572980459;
constexpr double kD = 0.091576213509771;
constexpr std::array<Quadrature, 6> kSamples = {{{0.223381589678011, {kA, kB, kB}},
                                                 {0.223381589678011, {kB, kA, kB}},
                                                 {0.223381589678011, {kB, kB, kA}},
                                                 {0.109951743655322, {kC, kD, kD}},
                                                 {0.109951743655322, {kD, kC, kD}},
                                                 {0.109951743655322, {kD, kD, kC}}}};

/// Samples whose nearest surface faces another way belong to another sheet.
constexpr double kLeastAgreement = 0.5;
/// Weight that holds a vertex back, as a share of the samples' around it: what they hardly tell
/// about stays.
constexpr double kHold = 0.02;
/// A vertex moves by at most this share of its shortest edge.
constexpr double kLongestMove = 0.25;
constexpr double kSolverTolerance = 1e-6;
constexpr int kMostRetreats = 10;  ///< times that vertices are put back in a round
/// On a line where barycentric coordinates are below this.
constexpr double kOnEdge = 1e-9;
constexpr double kBoundMargin = 1e-9;  ///< of bounds on distances

/// A sample of a triangle of the result, and what it says about its three corners.
struct Sample {
  Vec3 place = Vec3::Zero();
  std::array<double, 3> reach = {0, 0, 0};  ///< its way towards the surface per move of a corner
  double distance = 0;                      ///< signed, along the normal of the surface
  double weight = 0;                        ///< area it stands for; 0 where it tells nothing
};

class Fit {
 public:
  Fit(const TriMesh& mesh, const QuadMesh& quads)
      : mesh_(mesh),
        quads_(quads),
        surface_(mesh.positions, mesh.faces),
        face_normals_(face_normals(mesh)),
        triangles_(triangulate_faces(quads.mesh).corners),
        positions_(quads.mesh.positions) {
    for (Vec3& p : positions_) p -= mesh.origin;
    was_concave_ = concave_faces();
    set_moves();
    start_samples();
    measure();
  }

  /// Moves vertices once. \return whether any was moved
  bool improve() {
    const std::vector<double> height = solve();
    const std::vector<Vec3> before = positions_;
    const std::vector<double> error_before = vertex_errors();
    const double sum_before = error();
    for (std::size_t v = 0; v < positions_.size(); ++v) positions_[v] += height[v] * normal_[v];
    measure();
    // What helps most vertices may harm some; without them their neighbours are harmed in turn.
    for (int retreat = 0; retreat < kMostRetreats; ++retreat) {
      if (!take_back(before, error_before)) break;
      measure();
    }
    if (error() < sum_before && concave_faces() == was_concave_) return true;
    positions_ = before;
    measure();
    return false;
  }

  /// Integral of the squared distance over the result.
  [[nodiscard]] double error() const {
    double sum = 0;
    for (const Sample& sample : samples_) sum += sample.weight * sample.distance * sample.distance;
    return sum;
  }
  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }

 private:
  /// Whether a point of the input mesh lies on a feature or boundary line.
  [[nodiscard]] bool is_on_line(Index face, const std::array<double, 3>& barycentric) const {
    for (int i = 0; i < 3; ++i) {
      const Index opposite = 3 * face + (i + 1) % 3;
      if (barycentric[i] < kOnEdge && mesh_.is_barrier(opposite)) return true;
      if (barycentric[i] > 1 - kOnEdge && touches_barrier(3 * face + i)) return true;
    }
    return false;
  }

  [[nodiscard]] bool touches_barrier(Index corner) const {
    const Index first = mesh_.vertex_out[mesh_.from(corner)];
    for (Index h = first;;) {
      if (mesh_.is_barrier(h) || mesh_.is_barrier(TriMesh::prev(h))) return true;
      h = mesh_.rotate_ccw(h);
      if (h == kNone || h == first) return false;
    }
  }

  /// [F] whether a face of the result is concave.
  [[nodiscard]] std::vector<char> concave_faces() const {
    std::vector<char> concave(static_cast<std::size_t>(quads_.mesh.face_count()));
    for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
      concave[f] = is_concave_face(positions_, quads_.mesh.face(f)) ? 1 : 0;
    }
    return concave;
  }

  /// Puts vertices back around which the distance grew or a face became concave.
  /// \return whether there were any
  bool take_back(const std::vector<Vec3>& before, const std::vector<double>& error_before) {
    const std::vector<double> error_now = vertex_errors();
    std::vector<char> back(positions_.size(), 0);
    for (std::size_t v = 0; v < positions_.size(); ++v) back[v] = error_now[v] > error_before[v];
    const std::vector<char> concave = concave_faces();
    for (Index f = 0; f < quads_.mesh.face_count(); ++f) {
      if (concave[f] == was_concave_[f]) continue;
      for (const Index v : quads_.mesh.face(f)) back[v] = 1;
    }
    bool any = false;
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      if (back[v] == 0 || positions_[v] == before[v]) continue;
      positions_[v] = before[v];
      any = true;
    }
    return any;
  }

  /// The direction in which each vertex may move, and how far.
  void set_moves() {
    const std::vector<Vec3> wedge_normal = wedge_normals(mesh_, face_normals_);
    normal_.assign(positions_.size(), Vec3::Zero());
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      const Index face = quads_.provenance.face[v];
      const auto& barycentric = quads_.provenance.barycentric[v];
      if (is_on_line(face, barycentric)) continue;
      Vec3 normal = Vec3::Zero();
      for (int i = 0; i < 3; ++i) {
        normal += barycentric[i] * wedge_normal[mesh_.face_wedges[face][i]];
      }
      if (normal.norm() > 0) normal_[v] = normal.normalized();
    }
    longest_move_.assign(positions_.size(), 0);
    std::vector<double> shortest(positions_.size(), std::numeric_limits<double>::infinity());
    for (const auto& triangle : triangles_) {
      for (int i = 0; i < 3; ++i) {
        const Index a = triangle[i];
        const Index b = triangle[(i + 1) % 3];
        const double length = (positions_[a] - positions_[b]).norm();
        shortest[a] = std::min(shortest[a], length);
        shortest[b] = std::min(shortest[b], length);
      }
    }
    for (std::size_t v = 0; v < positions_.size(); ++v) {
      longest_move_[v] = std::isfinite(shortest[v]) ? kLongestMove * shortest[v] : 0;
    }
  }

  [[nodiscard]] Vec3 place(Index triangle, const Quadrature& rule) const {
    const auto& corners = triangles_[triangle];
    return rule.at[0] * positions_[corners[0]] + rule.at[1] * positions_[corners[1]] +
           rule.at[2] * positions_[corners[2]];
  }

  /// Gives each sample a bound on its distance: that from the foot of its triangle's first corner.
  void start_samples() {
    samples_.resize(triangles_.size() * kSamples.size());
    measured_.assign(positions_.size(), Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      const Index corner = triangles_[t].front();
      const auto& face = mesh_.faces[quads_.provenance.face[corner]];
      Vec3 foot = Vec3::Zero();
      for (int i = 0; i < 3; ++i) {
        foot += quads_.provenance.barycentric[corner][i] * mesh_.positions[face[i]];
      }
      for (std::size_t s = 0; s < kSamples.size(); ++s) {
        Sample& sample = samples_[t * kSamples.size() + s];
        sample.place = place(static_cast<Index>(t), kSamples[s]);
        sample.distance = (sample.place - foot).norm();
      }
    }
  }

  /// Measures a sample again. \param before  what it was, whose distance bounds the new one
  [[nodiscard]] Sample sample(Index triangle, const Quadrature& rule, const Sample& before) const {
    const auto& corners = triangles_[triangle];
    const Vec3& a = positions_[corners[0]];
    const Vec3& b = positions_[corners[1]];
    const Vec3& c = positions_[corners[2]];
    const Vec3 cross = (b - a).cross(c - a);
    const double area2 = cross.norm();
    Sample result;
    const Vec3 q = place(triangle, rule);
    result.place = q;
    const double bound = std::abs(before.distance) + (q - before.place).norm();
    const ClosestPoint nearest = surface_.closest_within(q, (1 + kBoundMargin) * bound + margin());
    const Vec3& normal = face_normals_[nearest.triangle];
    const bool same_sheet = normal.dot(cross) > kLeastAgreement * area2;
    // Where sheets differ the distance still counts, so that it cannot be made to grow unseen.
    result.weight = rule.weight * area2 / 2;
    result.distance = nearest.distance;
    if (!same_sheet || !(area2 > 0)) return result;
    const Vec3 way = surface_.point(nearest) - q;
    const Vec3 direction = nearest.distance > 1e-12 * mesh_.diagonal
                               ? Vec3(std::copysign(1.0, way.dot(normal)) * way.normalized())
                               : normal;
    result.distance = way.dot(direction);
    for (int i = 0; i < 3; ++i) {
      result.reach[i] = rule.at[i] * direction.dot(normal_[corners[i]]);
    }
    return result;
  }

  /// Keeps rounding from making a bound too tight.
  [[nodiscard]] double margin() const { return kBoundMargin * mesh_.diagonal; }

  /// Measures the samples of all triangles of which a corner has moved.
  void measure() {
    tbb::parallel_for(std::size_t{0}, triangles_.size(), [&](std::size_t t) {
      const bool same = std::all_of(triangles_[t].begin(), triangles_[t].end(),
                                    [&](Index v) { return positions_[v] == measured_[v]; });
      if (same) return;
      for (std::size_t s = 0; s < kSamples.size(); ++s) {
        Sample& own = samples_[t * kSamples.size() + s];
        own = sample(static_cast<Index>(t), kSamples[s], own);
      }
    });
    measured_ = positions_;
  }

  /// [V] squared distance around each vertex.
  [[nodiscard]] std::vector<double> vertex_errors() const {
    std::vector<double> errors(positions_.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      double sum = 0;
      for (std::size_t s = 0; s < kSamples.size(); ++s) {
        const Sample& sample = samples_[t * kSamples.size() + s];
        sum += sample.weight * sample.distance * sample.distance;
      }
      for (const Index v : triangles_[t]) errors[v] += sum;
    }
    return errors;
  }

  /// [V] how far to move each vertex along its normal.
  [[nodiscard]] std::vector<double> solve() const {
    const auto n = static_cast<Index>(positions_.size());
    std::vector<Eigen::Triplet<double>> entries;
    entries.reserve(triangles_.size() * 9 + positions_.size());
    Eigen::VectorXd right = Eigen::VectorXd::Zero(n);
    std::vector<double> hold(positions_.size(), 0);
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      Eigen::Matrix3d local = Eigen::Matrix3d::Zero();
      for (std::size_t s = 0; s < kSamples.size(); ++s) {
        const Sample& sample = samples_[t * kSamples.size() + s];
        for (int i = 0; i < 3; ++i) {
          right[triangles_[t][i]] += sample.weight * sample.reach[i] * sample.distance;
          hold[triangles_[t][i]] += kHold * sample.weight / 3;
          for (int j = 0; j < 3; ++j) {
            local(i, j) += sample.weight * sample.reach[i] * sample.reach[j];
          }
        }
      }
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          entries.emplace_back(triangles_[t][i], triangles_[t][j], local(i, j));
        }
      }
    }
    for (Index v = 0; v < n; ++v) entries.emplace_back(v, v, std::max(hold[v], 1e-300));
    Eigen::SparseMatrix<double> matrix(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver;
    solver.setTolerance(kSolverTolerance);
    solver.compute(matrix);
    const Eigen::VectorXd solution = solver.solve(right);
    std::vector<double> height(positions_.size(), 0);
    for (Index v = 0; v < n; ++v) {
      if (!std::isfinite(solution[v])) continue;
      height[v] = std::clamp(solution[v], -longest_move_[v], longest_move_[v]);
    }
    return height;
  }

  const TriMesh& mesh_;
  const QuadMesh& quads_;
  SurfaceDistance surface_;
  std::vector<Vec3> face_normals_;               ///< of the input
  std::vector<std::array<Index, 3>> triangles_;  ///< of the result
  std::vector<Vec3> positions_;                  ///< of the result, relative to the mesh's origin
  std::vector<char> was_concave_;                ///< [F]
  std::vector<Vec3> normal_;                     ///< [V] unit; zero where a vertex stays
  std::vector<double> longest_move_;             ///< [V]
  std::vector<Vec3> measured_;                   ///< [V] positions when last measured
  std::vector<Sample> samples_;                  ///< [triangles * kSamples]
};

}  // namespace

FitResult fit_vertices(const TriMesh& mesh, const QuadMesh& quads, const FitOptions& options,
                       Observer& observer) {
  FitResult result{quads, {}};
  if (options.rounds == 0 || quads.mesh.face_count() == 0) return result;
  observer.report("measuring distances", 0);
  Fit fit(mesh, quads);
  const double before = fit.error();
  std::int64_t rounds = 0;
  for (bool going = true; going && rounds < options.rounds; ++rounds) {
    going = fit.improve();
    observer.report("moving vertices", double(rounds + 1) / static_cast<double>(options.rounds));
  }
  double moved = 0;
  for (std::size_t v = 0; v < quads.mesh.positions.size(); ++v) {
    result.quads.mesh.positions[v] = fit.positions()[v] + mesh.origin;
    moved = std::max(moved, (result.quads.mesh.positions[v] - quads.mesh.positions[v]).norm());
  }
  result.report.set("fit.rounds", rounds);
  result.report.set("fit.rms_ratio", before > 0 ? std::sqrt(fit.error() / before) : 1.0);
  result.report.set("fit.longest_move", moved);
  return result;
}

}  // namespace strake
