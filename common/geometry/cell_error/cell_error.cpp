#include "common/geometry/cell_error/cell_error.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace strake {
namespace {

constexpr int kMostInputRows = 64;

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

/// Measures from one face of the result to the input.
Sums measure_face(const ComparedSurfaces& surfaces, Index f, int rows, Mat3& bend) {
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
  bend = has_plane ? fit.bend() : Mat3(Mat3::Zero());
  return sums;
}

/// Measures from the input to the faces of the result nearest to its samples: its vertices, and a
/// grid of places in faces that are larger than the distance of samples.
std::vector<Sums> measure_input(const ComparedSurfaces& surfaces, double input_step,
                                std::vector<Index>& vertex_cell) {
  struct Hit {
    Index triangle = kNone;
    double distance = 0;
  };
  const TriMesh& mesh = surfaces.mesh();
  const auto look = [&](const Vec3& p, Index guess) {
    const ClosestPoint foot = surfaces.result().closest_near(p, guess);
    return Hit{foot.triangle, foot.distance};
  };
  std::vector<double> areas(mesh.faces.size());
  double total = 0;
  for (std::size_t f = 0; f < areas.size(); ++f) {
    areas[f] = area(mesh.positions, mesh.faces[f]);
    total += areas[f];
  }
  const auto cells = static_cast<std::size_t>(surfaces.faces().face_count());
  const double step = input_step * std::sqrt(total / static_cast<double>(cells));
  const auto rows_of = [&](std::size_t f) {
    const double rows = std::ceil(std::sqrt(2 * areas[f]) / step);
    return static_cast<int>(std::clamp(rows, 1.0, double(kMostInputRows)));
  };

  std::vector<Hit> at_vertex(mesh.positions.size());
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, at_vertex.size()), [&](const auto& range) {
    Index guess = kNone;
    for (std::size_t v = range.begin(); v < range.end(); ++v) {
      at_vertex[v] = look(mesh.positions[v], guess);
      guess = at_vertex[v].triangle;
    }
  });
  std::vector<std::size_t> first(mesh.faces.size() + 1, 0);  // into `inside`, of each face
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const int rows = rows_of(f);
    first[f + 1] = first[f] + static_cast<std::size_t>(rows == 1 ? 0 : place_count(rows));
  }
  std::vector<Hit> inside(first.back());
  tbb::parallel_for(std::size_t{0}, mesh.faces.size(), [&](std::size_t f) {
    if (first[f] == first[f + 1]) return;
    Index guess = at_vertex[mesh.faces[f][0]].triangle;
    std::size_t hit = first[f];
    for_each_place(rows_of(f), [&](const Barycentric& at) {
      inside[hit] = look(place(mesh.positions, mesh.faces[f], at), guess);
      guess = inside[hit++].triangle;
    });
  });

  const std::vector<Index>& cell_of = surfaces.triangles().face;
  std::vector<Sums> sums(cells);
  std::vector<double> weights(mesh.positions.size(), 0);  // of small faces
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const std::size_t count = first[f + 1] - first[f];
    const double share = areas[f] / static_cast<double>(count == 0 ? 3 : count);
    for (std::size_t i = first[f]; i < first[f + 1]; ++i) {
      sums[cell_of[inside[i].triangle]].add(inside[i].distance, share);
    }
    if (count > 0) continue;
    for (const Index v : mesh.faces[f]) weights[v] += share;
  }
  vertex_cell.clear();
  for (std::size_t v = 0; v < at_vertex.size(); ++v) {
    const Index cell = cell_of[at_vertex[v].triangle];
    sums[cell].add(at_vertex[v].distance, weights[v]);
    vertex_cell.push_back(cell);
  }
  return sums;
}

}  // namespace

Mat3 cell_bend(const ComparedSurfaces& surfaces, Index face) {
  Mat3 bend;
  measure_face(surfaces, face, CellSampling{}.rows, bend);
  return bend;
}

ErrorMap measure_cells(const ComparedSurfaces& surfaces, const CellSampling& sampling) {
  const auto cells = static_cast<std::size_t>(surfaces.faces().face_count());
  ErrorMap map;
  map.cells.resize(cells);
  std::vector<Sums> to_input(cells);
  tbb::parallel_for(std::size_t{0}, cells, [&](std::size_t f) {
    to_input[f] = measure_face(surfaces, static_cast<Index>(f), sampling.rows, map.cells[f].bend);
  });
  const std::vector<Sums> from_input =
      measure_input(surfaces, sampling.input_step, map.vertex_cell);
  Sums all_to;
  Sums all_from;
  for (std::size_t f = 0; f < cells; ++f) {
    Sums both = to_input[f];
    both.add(from_input[f]);
    map.cells[f].rms = std::sqrt(both.mean_square());
    map.cells[f].largest = both.largest;
    all_to.add(to_input[f]);
    all_from.add(from_input[f]);
  }
  map.rms = std::sqrt((all_to.mean_square() + all_from.mean_square()) / 2);
  map.largest = std::max(all_to.largest, all_from.largest);
  return map;
}

}  // namespace strake
