#include "stages/trace/line_flow.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "common/geometry/conjugate_gradients.h"
#include "common/geometry/frames.h"
#include "common/geometry/mesh_measures.h"

namespace strake {
namespace {

/// Change of log s from cell to cell that is followed.
constexpr double kFastest = 0.2;
constexpr double kMostChange = 0.2231435513142097;  ///< log 1.25
constexpr double kAccuracy = 0.1;                   ///< of the solution; more changes no figure
/// Of a face's terms, over its area: beyond, single precision would not hold the system positive.
constexpr double kStiffest = 1e5;
/// Faces whose terms are made at a time.
constexpr Index kFacesAtATime = 1 << 15;

/// What one face adds for one family: (slope . x - missing)^2, x the changes of log s at its keys.
struct FlowTerm {
  std::array<Index, 3> key = {kNone, kNone, kNone};  ///< kNone: nothing
  std::array<double, 3> slope = {0, 0, 0};
  double missing = 0;
};

class LineFlow {
 public:
  LineFlow(const TriMesh& mesh, const PrincipalField& field, const ArmBonds& bonds, double cells,
           const Spacing& spacing)
      : mesh_(mesh), field_(field), bonds_(bonds), cells_(cells), normals_(mesh) {
    weigh_changes();
    right_.assign(diagonal_.size(), 0);
    coupling_.assign(2 * static_cast<std::size_t>(bonds.count()), 0);
    add_faces(spacing);
  }

  /// [keys] by how much log s changes.
  [[nodiscard]] std::vector<double> solve() const {
    std::vector<double> change(right_.size(), 0);
    SolverVectors<double> vectors{.right = right_};
    SolverOptions options;
    options.tolerance = kAccuracy;
    conjugate_gradients(
        options,
        [&](Index key, const std::vector<double>& x) {
          double sum = diagonal_[key] * x[key];
          for (Index at = bonds_.first(key / 2); at < bonds_.first(key / 2 + 1); ++at) {
            sum += double{coupling_[2 * at + (key & 1)]} * x[bonds_.bonded(at, key)];
          }
          return sum;
        },
        [&](Index key, double value) { return value / diagonal_[key]; },
        [](double a, double b) { return a * b; }, change, vectors);
    return change;
  }

 private:
  void weigh_changes() {
    constexpr double kLeast = std::numeric_limits<double>::min();
    const double unit = mesh_.diagonal * mesh_.diagonal;  // single precision is to hold all units
    for (const double area : wedge_areas(mesh_)) {
      diagonal_.insert(diagonal_.end(), 2, std::max(area / unit, kLeast));
    }
  }

  void add_faces(const Spacing& spacing) {
    std::vector<std::array<FlowTerm, 2>> terms;
    for (Index begin = 0; begin < mesh_.face_count(); begin += kFacesAtATime) {
      terms.resize(std::min(kFacesAtATime, mesh_.face_count() - begin));
      tbb::parallel_for(std::size_t{0}, terms.size(), [&](std::size_t i) {
        terms[i] = terms_of(spacing, begin + static_cast<Index>(i));
      });
      for (const auto& pair : terms) {
        for (const FlowTerm& term : pair) add(term);
      }
    }
  }

  /// Of both families.
  [[nodiscard]] std::array<FlowTerm, 2> terms_of(const Spacing& spacing, Index face) const {
    const Vec3 cross = face_cross(mesh_, face);
    const double double_area = cross.norm();
    if (!has_own_normal(mesh_, face)) return {};
    const Vec3 normal = normals_[face];
    std::array<Vec3, 3> arm;       // of the corners' crosses, in the face
    std::array<Vec3, 3> gradient;  // of the corners' hat functions
    std::array<std::array<double, 2>, 3> distance;
    double cell = 0;
    double steepest = 0;
    for (Index i = 0; i < 3; ++i) {
      const Index w = mesh_.face_wedges[face][i];
      arm[i] = rotate_between(field_.normal[w], normal, field_.cross[w]);
      const Index across = TriMesh::next(3 * face + i);
      const Vec3 edge = mesh_.positions[mesh_.to(across)] - mesh_.positions[mesh_.from(across)];
      gradient[i] = normal.cross(edge) / double_area;
      steepest = std::max(steepest, gradient[i].norm());
      distance[i] = {spacing.along[w], spacing.across[w]};
      cell += std::sqrt(spacing.along[w] * spacing.across[w]) / 3;
    }
    const double length = std::min(cells_ * cell, std::sqrt(kStiffest) / steepest);
    const double root = length * std::sqrt(double_area / 2) / mesh_.diagonal;
    std::array<FlowTerm, 2> terms;
    for (const Index parity : {0, 1}) {
      const std::optional<std::array<Index, 3>> keys = bonds_.keys_in(face, parity);
      if (!keys) break;
      FlowTerm& term = terms[parity];
      term.key = *keys;
      std::array<Vec3, 3> along;  // unit directions of the lines
      for (std::size_t i = 0; i < 3; ++i) {
        along[i] = term.key[i] % 2 == 0 ? Vec3(normal.cross(arm[i])) : arm[i];
        if (along[i].dot(along[0]) < 0) along[i] = -along[i];
      }
      const Vec3 mean = (along[0] + along[1] + along[2]).normalized();
      double divergence = 0;
      double change = 0;
      for (std::size_t i = 0; i < 3; ++i) {
        const double slope = gradient[i].dot(mean);
        divergence += gradient[i].dot(along[i]);
        // Of ratios, which have no unit; the slopes' sum is 0.
        change += slope * std::log(distance[i][term.key[i] % 2] / distance[0][parity]);
        term.slope[i] = root * slope;
      }
      term.missing = root * std::clamp(divergence - change, -kFastest / cell, kFastest / cell);
    }
    return terms;
  }

  void add(const FlowTerm& term) {
    if (term.key[0] == kNone) return;
    for (std::size_t i = 0; i < 3; ++i) {
      right_[term.key[i]] += term.slope[i] * term.missing;
      diagonal_[term.key[i]] += term.slope[i] * term.slope[i];
      for (const std::size_t j : {(i + 1) % 3, (i + 2) % 3}) {
        couple(term.key[i], term.key[j], term.slope[i] * term.slope[j]);
      }
    }
  }

  void couple(Index key, Index other, double value) {
    for (Index at = bonds_.first(key / 2); at < bonds_.first(key / 2 + 1); ++at) {
      if (bonds_.bonded(at, key) != other) continue;
      coupling_[2 * at + (key & 1)] += static_cast<float>(value);
      return;
    }
  }

  const TriMesh& mesh_;
  const PrincipalField& field_;
  const ArmBonds& bonds_;
  double cells_;
  FaceNormals normals_;
  std::vector<double> diagonal_;  ///< [keys]
  std::vector<double> right_;     ///< [keys]
  std::vector<float> coupling_;   ///< [2 bonds] of the two keys of the wedge that has the bond
};

}  // namespace

void follow_lines(const TriMesh& mesh, const PrincipalField& field, const ArmBonds& bonds,
                  double cells, Spacing& spacing) {
  if (!(cells > 0)) return;
  const std::vector<double> change = LineFlow(mesh, field, bonds, cells, spacing).solve();
  for (Index key = 0; key < static_cast<Index>(change.size()); ++key) {
    // On both sides of a feature line by the same.
    double sum = change[key];
    int count = 1;
    bonds.for_each_tied(key, [&](Index other) {
      sum += change[other];
      ++count;
    });
    double& distance = key % 2 == 0 ? spacing.along[key / 2] : spacing.across[key / 2];
    distance *= std::exp(std::clamp(sum / count, -kMostChange, kMostChange));
  }
}

}  // namespace strake
