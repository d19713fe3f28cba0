#include "stages/fit/deviation.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/topology/own_component.h"

namespace strake::fitting {
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
constexpr std::array<Quadrature, 6> kRule = {{{0.223381589678011, {kA, kB, kB}},
                                              {0.223381589678011, {kB, kA, kB}},
                                              {0.223381589678011, {kB, kB, kA}},
                                              {0.109951743655322, {kC, kD, kD}},
                                              {0.109951743655322, {kD, kC, kD}},
                                              {0.109951743655322, {kD, kD, kC}}}};

/// Shorter ways, as a share of the diagonal, have no direction of their own.
constexpr double kNoWay = 1e-12;
/// Distance that counts double, in root mean squares.
constexpr double kFar = 2;
/// Samples of the surface for each triangle of the result, at most.
constexpr std::size_t kSurfaceSamples = 4;

/// Fills in distance and direction. \param way  from the result to the surface
void set_way(Gap& gap, const Vec3& way, const Vec3& normal, double shortest) {
  const double length = way.norm();
  gap.direction =
      length > shortest ? Vec3(std::copysign(1 / length, way.dot(normal)) * way) : normal;
  gap.distance = way.dot(gap.direction);
}

/// The least-squares problem of samples on one triangle.
class TriangleTerms {
 public:
  /// \param at  of the sample, barycentric
  void add(const Gap& gap, const std::array<double, 3>& at, double weight) {
    const Vec3 weighted = weight * gap.direction;
    const Mat3 along = weighted * gap.direction.transpose();
    int pair = 0;
    for (int i = 0; i < 3; ++i) {
      right_[i] += at[i] * gap.distance * weighted;
      for (int j = i; j < 3; ++j) blocks_[pair++] += at[i] * at[j] * along;
    }
  }

  void add_to(BlockSystem& system, const std::array<Index, 3>& corners) const {
    int pair = 0;
    for (int i = 0; i < 3; ++i) {
      system.add_right(corners[i], right_[i]);
      for (int j = i; j < 3; ++j, ++pair) {
        system.add(corners[i], corners[j], blocks_[pair]);
        if (i != j) system.add(corners[j], corners[i], blocks_[pair]);
      }
    }
  }

 private:
  std::array<Mat3, 6> blocks_ = {Mat3::Zero(), Mat3::Zero(), Mat3::Zero(),
                                 Mat3::Zero(), Mat3::Zero(), Mat3::Zero()};  ///< symmetric
  std::array<Vec3, 3> right_ = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
};

/// Adds the terms of triangles in their order; they are made at the same time, a few at once.
/// \param make  fills in the terms of triangle number i, and returns its corners
template <class Make>
void add_in_turn(BlockSystem& system, std::size_t count, const Make& make) {
  constexpr std::size_t kAtOnce = 2048;
  std::vector<TriangleTerms> terms(std::min(count, kAtOnce));
  std::vector<std::array<Index, 3>> corners(terms.size());
  for (std::size_t first = 0; first < count; first += kAtOnce) {
    const std::size_t some = std::min(kAtOnce, count - first);
    tbb::parallel_for(std::size_t{0}, some, [&](std::size_t i) {
      terms[i] = {};
      corners[i] = make(first + i, terms[i]);
    });
    for (std::size_t i = 0; i < some; ++i) terms[i].add_to(system, corners[i]);
  }
}

}  // namespace

Deviation::Deviation(const TriMesh& mesh, const SurfaceDistance& surface,
                     const FaceNormals& face_normals, const std::vector<Vec3>& wedge_normals,
                     std::size_t triangles)
    : mesh_(mesh),
      surface_(surface),
      face_normals_(face_normals),
      step_(mesh.positions.size() / (kSurfaceSamples * triangles) + 1),
      normals_(mesh.positions.size() / step_, Vec3::Zero()),
      areas_(normals_.size(), 0.0),
      from_surface_(normals_.size()) {
  const std::vector<double> wedge_area = wedge_areas(mesh);
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const auto vertex = static_cast<std::size_t>(mesh.wedge_vertex[w]);
    const std::size_t sample = vertex / step_;
    if (vertex % step_ != 0 || sample >= normals_.size()) continue;
    areas_[sample] += wedge_area[w];
    normals_[sample] += wedge_normals[w];
  }
  for (Vec3& normal : normals_) normal.normalize();
  for (double& area : areas_) area *= static_cast<double>(step_);
}

void Deviation::measure(const std::vector<Vec3>& positions,
                        const std::vector<std::array<Index, 3>>& triangles) {
  measure_result(positions, triangles);
  measure_surface(positions, triangles);
  if (per_far_ < 0) {
    const double rms = std::sqrt(mean());
    per_far_ = rms > 0 ? 1 / (kFar * rms) : 0;
  }
}

void Deviation::measure_result(const std::vector<Vec3>& positions,
                               const std::vector<Triangle>& triangles) {
  const bool is_first = from_result_.empty();
  if (is_first) {
    positions_.assign(positions.size(), Vec3::Zero());
    triangles_.assign(triangles.size(), {kNone, kNone, kNone});
    double_areas_.resize(triangles.size());
    from_result_.resize(triangles.size() * kRule.size());
  }
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    const Triangle& corners = triangles[t];
    const bool is_same = triangles_[t] == corners && std::ranges::all_of(corners, [&](Index v) {
                           return positions_[v] == positions[v];
                         });
    if (is_same) return;
    const Vec3& a = positions[corners[0]];
    const Vec3& b = positions[corners[1]];
    const Vec3& c = positions[corners[2]];
    const Vec3 cross = (b - a).cross(c - a);
    const double area2 = cross.norm();
    double_areas_[t] = area2;
    for (std::size_t s = 0; s < kRule.size(); ++s) {
      Gap& own = from_result_[t * kRule.size() + s];
      const auto& at = kRule[s].at;
      const Vec3 place = at[0] * a + at[1] * b + at[2] * c;
      // The first time the sample before is the best guess.
      const Index guess =
          is_first && s > 0 ? from_result_[t * kRule.size() + s - 1].nearest : own.nearest;
      const ClosestPoint nearest = surface_.closest_near(place, guess);
      own = {nearest.distance, Vec3::Zero(), nearest.triangle};
      const Vec3 normal = face_normals_[nearest.triangle];
      if (!(normal.dot(cross) > kSameSheet * area2)) continue;
      set_way(own, surface_.point(nearest) - place, normal, kNoWay * mesh_.diagonal);
    }
  });
  positions_ = positions;
  triangles_ = triangles;
}

void Deviation::measure_surface(const std::vector<Vec3>& positions,
                                const std::vector<Triangle>& triangles) {
  const SurfaceDistance result(positions, triangles);
  tbb::parallel_for(std::size_t{0}, from_surface_.size(), [&](std::size_t s) {
    const Vec3& place = mesh_.positions[s * step_];
    auto& [gap, at] = from_surface_[s];
    const ClosestPoint nearest = result.closest_near(place, gap.nearest);
    gap = {nearest.distance, Vec3::Zero(), nearest.triangle};
    at = nearest.barycentric;
    const Triangle& corners = triangles[nearest.triangle];
    const Vec3& a = positions[corners[0]];
    const Vec3 cross = (positions[corners[1]] - a).cross(positions[corners[2]] - a);
    if (!(normals_[s].dot(cross) > kSameSheet * cross.norm())) return;
    set_way(gap, place - result.point(nearest), normals_[s], kNoWay * mesh_.diagonal);
  });
}

double Deviation::weight(std::size_t sample) const {
  return kRule[sample % kRule.size()].weight * double_areas_[sample / kRule.size()] / 2;
}

template <class Term>
double Deviation::sum_over(Term term) const {
  double sum = 0;
  for (std::size_t s = 0; s < from_result_.size(); ++s) sum += term(weight(s), from_result_[s]);
  for (std::size_t s = 0; s < from_surface_.size(); ++s) {
    sum += term(areas_[s], from_surface_[s].gap);
  }
  return sum;
}

double Deviation::sum() const {
  return sum_over(
      [](double weight, const Gap& gap) { return weight * gap.distance * gap.distance; });
}

double Deviation::cost() const {
  return sum_over([&](double weight, const Gap& gap) {
    return weight * gap.distance * gap.distance * (1 + std::abs(gap.distance) * per_far_);
  });
}

/// Slope of the cost over the squared distance, for an area of 1.
double Deviation::slope_of(const Gap& gap) const {
  return 1 + 1.5 * std::abs(gap.distance) * per_far_;
}

double Deviation::mean() const {
  const double area = sum_over([](double weight, const Gap&) { return weight; });
  return area > 0 ? sum() / area : 0.0;
}

double Deviation::largest() const {
  double largest = 0;
  for (const Gap& gap : from_result_) largest = std::max(largest, std::abs(gap.distance));
  for (const SurfaceGap& from : from_surface_) {
    largest = std::max(largest, std::abs(from.gap.distance));
  }
  return largest;
}

void Deviation::add_to(BlockSystem& system) const {
  // The six samples of a triangle concern the same vertices: their sum is looked up once.
  add_in_turn(system, triangles_.size(), [&](std::size_t t, TriangleTerms& terms) {
    for (std::size_t i = 0; i < kRule.size(); ++i) {
      const std::size_t s = t * kRule.size() + i;
      terms.add(from_result_[s], kRule[i].at, slope_of(from_result_[s]) * weight(s));
    }
    return triangles_[t];
  });
  add_in_turn(system, from_surface_.size(), [&](std::size_t s, TriangleTerms& terms) {
    const auto& [gap, at] = from_surface_[s];
    terms.add(gap, at, slope_of(gap) * areas_[s]);
    return triangles_[gap.nearest];
  });
}

}  // namespace strake::fitting
