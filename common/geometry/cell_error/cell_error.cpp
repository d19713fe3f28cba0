#include "common/geometry/cell_error/cell_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

namespace strake {
namespace {

constexpr double kMostInputRows = 64;

using Triangle = std::array<Index, 3>;
using Barycentric = std::array<double, 3>;

/// Calls use(barycentric) for the centres of a grid of rows (rows + 1) / 2 places of a triangle.
template <class Use>
void for_each_place(int rows, const Use& use) {
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; i + j < rows; ++j) {
      const double u = (i + 1.0 / 3) / rows;
      const double v = (j + 1.0 / 3) / rows;
      use(Barycentric{1 - u - v, u, v});
    }
  }
}

int place_count(int rows) { return rows * (rows + 1) / 2; }

Vec3 place(const std::vector<Vec3>& positions, const Triangle& corners, const Barycentric& at) {
  return at[0] * positions[corners[0]] + at[1] * positions[corners[1]] +
         at[2] * positions[corners[2]];
}

double area(const std::vector<Vec3>& positions, const Triangle& corners) {
  const Vec3& a = positions[corners[0]];
  return (positions[corners[1]] - a).cross(positions[corners[2]] - a).norm() / 2;
}

}  // namespace

/// What CellMeasure keeps.
namespace measuring {

/// Sums over samples.
struct Sums {
  double square = 0;
  double weight = 0;
  double largest = 0;

  void add(double distance, double weight_of_sample) {
    square += weight_of_sample * distance * distance;
    weight += weight_of_sample;
    largest = std::max(largest, distance);
  }
  void add(const Sums& other) {
    square += other.square;
    weight += other.weight;
    largest = std::max(largest, other.largest);
  }
  [[nodiscard]] double mean_square() const { return weight > 0 ? square / weight : 0; }
};

/// Measured from one face of the result to the input.
struct FromFace {
  Sums sums;
  Mat3 bend = Mat3::Zero();
};

/// What of a result is nearest to a sample of the input.
struct Hit {
  Index cell = kNone;
  double distance = 0;
};

/// Samples of the input: its vertices, and a grid of places in faces that are larger than the
/// distance of samples.
class InputSamples {
 public:
  /// \param step  from sample to sample, in edges of a mean cell
  /// \param cells  of the result
  InputSamples(const TriMesh& mesh, double step, std::size_t cells) {
    areas_.reserve(mesh.faces.size());
    rows_.reserve(mesh.faces.size());
    first_.reserve(mesh.faces.size() + 1);
    for (const auto& face : mesh.faces) areas_.push_back(area(mesh.positions, face));
    const double all = std::accumulate(areas_.begin(), areas_.end(), 0.0);
    step *= std::sqrt(all / static_cast<double>(cells));
    first_.push_back(0);
    for (const double own : areas_) {
      const double rows = std::clamp(std::ceil(std::sqrt(2 * own) / step), 1.0, kMostInputRows);
      rows_.push_back(static_cast<std::uint8_t>(rows));
      const int inside = rows_.back() == 1 ? 0 : place_count(rows_.back());
      first_.push_back(first_.back() + static_cast<std::size_t>(inside));
    }
    at_vertex_.resize(mesh.positions.size());
    inside_.resize(first_.back());
  }

  /// Calls look(place, hit, guess) for each sample, in parallel; `hit` is what is known of it, and
  /// `guess` what was nearest to the sample before, both to be set.
  template <class Look>
  void for_each(const TriMesh& mesh, const Look& look) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, at_vertex_.size()),
                      [&](const auto& range) {
                        Index guess = kNone;
                        for (std::size_t v = range.begin(); v < range.end(); ++v) {
                          look(mesh.positions[v], at_vertex_[v], guess);
                        }
                      });
    tbb::parallel_for(std::size_t{0}, rows_.size(), [&](std::size_t f) {
      if (first_[f] == first_[f + 1]) return;
      Index guess = kNone;
      std::size_t hit = first_[f];
      for_each_place(rows_[f], [&](const Barycentric& at) {
        look(place(mesh.positions, mesh.faces[f], at), inside_[hit++], guess);
      });
    });
  }

  /// [F of the result] of the samples nearest to each face
  [[nodiscard]] std::vector<Sums> sums(const TriMesh& mesh, std::size_t cells) const {
    std::vector<Sums> sums(cells);
    std::vector<double> weights(at_vertex_.size(), 0);  // of small faces
    for (std::size_t f = 0; f < rows_.size(); ++f) {
      const std::size_t count = first_[f + 1] - first_[f];
      const double share = areas_[f] / static_cast<double>(count == 0 ? 3 : count);
      for (std::size_t i = first_[f]; i < first_[f + 1]; ++i) {
        sums[inside_[i].cell].add(inside_[i].distance, share);
      }
      if (count > 0) continue;
      for (const Index v : mesh.faces[f]) weights[v] += share;
    }
    for (std::size_t v = 0; v < at_vertex_.size(); ++v) {
      sums[at_vertex_[v].cell].add(at_vertex_[v].distance, weights[v]);
    }
    return sums;
  }

  [[nodiscard]] std::vector<Index> vertex_cell() const {
    std::vector<Index> cells;
    for (const Hit& hit : at_vertex_) cells.push_back(hit.cell);
    return cells;
  }

 private:
  std::vector<double> areas_;       ///< [F]
  std::vector<std::uint8_t> rows_;  ///< [F] of places; one: none but the corners
  std::vector<std::size_t> first_;  ///< [F + 1] into `inside_`
  std::vector<Hit> at_vertex_;      ///< [V]
  std::vector<Hit> inside_;         ///< in faces
};

}  // namespace measuring

namespace {

using measuring::FromFace;
using measuring::Hit;
using measuring::InputSamples;
using measuring::Sums;

/// Least squares fit of heights s over a plane: s = c + g u + h v + a u^2 + b v^2 + t u v.
class BendFit {
 public:
  /// \param normal  of the plane, not zero
  BendFit(const Vec3& centre, const Vec3& normal)
      : centre_(centre), u_(normal.unitOrthogonal()), v_(normal.normalized().cross(u_)) {}

  void add(const Vec3& at, double height) {
    const double u = u_.dot(at - centre_);
    const double v = v_.dot(at - centre_);
    Row row;
    row << 1, u, v, u * u, v * v, u * v;
    normal_ += row * row.transpose();
    right_ += height * row;
    reach_ = std::max(reach_, std::hypot(u, v));
  }

  [[nodiscard]] Mat3 bend() const {
    if (!(reach_ > 0)) return Mat3::Zero();
    Row scale;
    scale << 1, reach_, reach_, reach_ * reach_, reach_ * reach_, reach_ * reach_;
    const Row inverse = scale.cwiseInverse();
    const Eigen::Matrix<double, 6, 6> scaled =
        inverse.asDiagonal() * normal_ * inverse.asDiagonal();
    const Row found = inverse.asDiagonal() * scaled.completeOrthogonalDecomposition().solve(
                                                 Row(inverse.asDiagonal() * right_));
    return found[3] * u_ * u_.transpose() + found[4] * v_ * v_.transpose() +
           found[5] / 2 * (u_ * v_.transpose() + v_ * u_.transpose());
  }

 private:
  using Row = Eigen::Matrix<double, 6, 1>;

  Vec3 centre_;
  Vec3 u_;
  Vec3 v_;
  Eigen::Matrix<double, 6, 6> normal_ = Eigen::Matrix<double, 6, 6>::Zero();
  Row right_ = Row::Zero();
  double reach_ = 0;
};

FromFace measure_face(const ComparedSurfaces& surfaces, Index f, int rows) {
  Sums sums;
  const std::vector<Vec3>& positions = surfaces.positions();
  const std::span<const Index> face = surfaces.faces().face(f);
  Vec3 centre = Vec3::Zero();
  Index guess = kNone;
  for (const Index v : face) {
    centre += positions[v] / static_cast<double>(face.size());
    const ClosestPoint foot = surfaces.input().closest_near(positions[v], guess);
    guess = foot.triangle;
    sums.add(foot.distance, 0);
  }
  const Vec3 normal = newell_normal(positions, face);
  const bool has_plane = normal.norm() > 0;
  BendFit fit(centre, has_plane ? normal : Vec3(Vec3::UnitX()));
  for (Index t = surfaces.first_triangle(f); t < surfaces.first_triangle(f + 1); ++t) {
    const Triangle& corners = surfaces.triangles().corners[t];
    const double weight = area(positions, corners) / place_count(rows);
    for_each_place(rows, [&](const Barycentric& at) {
      const Vec3 p = place(positions, corners, at);
      const ClosestPoint foot = surfaces.input().closest_near(p, guess);
      guess = foot.triangle;
      sums.add(foot.distance, weight);
      const double side =
          (p - surfaces.input().point(foot)).dot(surfaces.input_normals()[foot.triangle]);
      fit.add(p, std::copysign(foot.distance, -side));
    });
  }
  return {sums, has_plane ? fit.bend() : Mat3(Mat3::Zero())};
}

/// [F of `after`] the number of the same face, corner by corner, in `before`; kNone: there is none.
std::vector<Index> faces_before(const PolyMesh& before, const PolyMesh& after) {
  const auto corner_bits = [](const PolyMesh& mesh, Index face) {
    std::string bits;
    for (const Index v : mesh.face(face)) {
      const auto* p = reinterpret_cast<const char*>(mesh.positions[v].data());
      bits.append(p, 3 * sizeof(double));
    }
    return bits;
  };
  std::unordered_map<std::string, Index> number;
  for (Index f = 0; f < before.face_count(); ++f) number.emplace(corner_bits(before, f), f);
  std::vector<Index> result;
  for (Index f = 0; f < after.face_count(); ++f) {
    const auto found = number.find(corner_bits(after, f));
    result.push_back(found == number.end() ? kNone : found->second);
  }
  return result;
}

/// Looks for what is nearest to each sample.
void look(const ComparedSurfaces& surfaces, InputSamples& samples) {
  const std::vector<Index>& cell_of = surfaces.triangles().face;
  samples.for_each(surfaces.mesh(), [&](const Vec3& p, Hit& hit, Index& guess) {
    const ClosestPoint foot = surfaces.result().closest_near(p, guess);
    guess = foot.triangle;
    hit = {cell_of[foot.triangle], foot.distance};
  });
}

/// The same where what was nearest in a result before is known.
/// \param before  [F] see faces_before
/// \param cells   of the result before
void look_again(const ComparedSurfaces& surfaces, const std::vector<Index>& before,
                std::size_t cells, InputSamples& samples) {
  std::vector<Index> now(cells, kNone);
  FaceTriangles fresh;  // of faces that were not there
  for (std::size_t f = 0; f < before.size(); ++f) {
    if (before[f] != kNone) now[before[f]] = static_cast<Index>(f);
  }
  for (std::size_t t = 0; t < surfaces.triangles().face.size(); ++t) {
    const Index face = surfaces.triangles().face[t];
    if (before[face] != kNone) continue;
    fresh.corners.push_back(surfaces.triangles().corners[t]);
    fresh.face.push_back(face);
  }
  std::optional<SurfaceDistance> to_fresh;
  if (!fresh.corners.empty()) to_fresh.emplace(surfaces.positions(), fresh.corners);
  const std::vector<Index>& cell_of = surfaces.triangles().face;
  samples.for_each(surfaces.mesh(), [&](const Vec3& p, Hit& hit, Index& guess) {
    hit.cell = now[hit.cell];
    if (hit.cell == kNone) {
      const ClosestPoint foot = surfaces.result().closest_near(p, guess);
      guess = foot.triangle;
      hit = {cell_of[foot.triangle], foot.distance};
    } else if (to_fresh) {
      const ClosestPoint foot = to_fresh->closest_within(p, hit.distance);
      if (foot.triangle == kNone) return;
      const Index cell = fresh.face[foot.triangle];
      // Of what is equally near the first counts, as in a query of all.
      if (foot.distance < hit.distance || cell < hit.cell) hit = {cell, foot.distance};
    }
  });
}

}  // namespace

struct CellMeasure::Known {
  PolyMesh result;  ///< the last one; positions and faces alone
  std::vector<FromFace> from_face;
  InputSamples samples;
};

CellMeasure::CellMeasure(const CellSampling& sampling) : sampling_(sampling) {}

CellMeasure::~CellMeasure() = default;

ErrorMap CellMeasure::measure(const ComparedSurfaces& surfaces) {
  const auto cells = static_cast<std::size_t>(surfaces.faces().face_count());
  std::vector<Index> before(cells, kNone);
  if (known_) {
    before = faces_before(known_->result, surfaces.faces());
    look_again(surfaces, before, known_->from_face.size(), known_->samples);
  } else {
    known_ = std::make_unique<Known>(
        Known{{}, {}, InputSamples(surfaces.mesh(), sampling_.input_step, cells)});
    look(surfaces, known_->samples);
  }
  std::vector<FromFace> from_face(cells);
  tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t f) {
    from_face[f] = before[f] != kNone
                       ? known_->from_face[before[f]]
                       : measure_face(surfaces, static_cast<Index>(f), sampling_.rows);
  });
  known_->from_face = std::move(from_face);
  known_->result.positions = surfaces.faces().positions;
  known_->result.corners = surfaces.faces().corners;
  known_->result.offsets = surfaces.faces().offsets;

  ErrorMap map;
  map.cells.resize(cells);
  map.vertex_cell = known_->samples.vertex_cell();
  const std::vector<Sums> from_input = known_->samples.sums(surfaces.mesh(), cells);
  Sums all_to;
  Sums all_from;
  for (std::size_t f = 0; f < cells; ++f) {
    const FromFace& to_input = known_->from_face[f];
    Sums both = to_input.sums;
    both.add(from_input[f]);
    map.cells[f] = {std::sqrt(both.mean_square()), both.largest, to_input.bend};
    all_to.add(to_input.sums);
    all_from.add(from_input[f]);
  }
  map.rms = std::sqrt((all_to.mean_square() + all_from.mean_square()) / 2);
  map.largest = std::max(all_to.largest, all_from.largest);
  return map;
}

ErrorMap measure_cells(const ComparedSurfaces& surfaces, const CellSampling& sampling) {
  return CellMeasure(sampling).measure(surfaces);
}

Mat3 cell_bend(const ComparedSurfaces& surfaces, Index face) {
  return measure_face(surfaces, face, CellSampling{}.rows).bend;
}

}  // namespace strake
