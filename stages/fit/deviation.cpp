#include "stages/fit/deviation.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/mesh_measures.h"

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

/// Samples whose nearest surface faces another way belong to another sheet.
constexpr double kLeastAgreement = 0.5;
/// Shorter ways, as a share of the diagonal, have no direction of their own.
constexpr double kNoWay = 1e-12;
/// Distance that counts double, in root mean squares.
constexpr double kFar = 2;
/// Samples of the surface for each triangle of the result, at most.
constexpr std::size_t kSurfaceSamples = 4;

/// Fills in distance and direction. \param way  from the result to the surface
void set_way(DistanceSample& sample, const Vec3& way, const Vec3& normal, double shortest) {
  const double length = way.norm();
  sample.direction =
      length > shortest ? Vec3(std::copysign(1 / length, way.dot(normal)) * way) : normal;
  sample.distance = way.dot(sample.direction);
}

/// The least-squares problem of samples on one triangle.
class TriangleTerms {
 public:
  /// \param slope  factor on the weight
  void add(const DistanceSample& sample, double slope) {
    const Vec3 weighted = slope * sample.weight * sample.direction;
    const Mat3 along = weighted * sample.direction.transpose();
    int pair = 0;
    for (int i = 0; i < 3; ++i) {
      right_[i] += sample.at[i] * sample.distance * weighted;
      for (int j = i; j < 3; ++j) blocks_[pair++] += sample.at[i] * sample.at[j] * along;
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

}  // namespace

Deviation::Deviation(const TriMesh& mesh, const SurfaceDistance& surface,
                     const std::vector<Vec3>& face_normals, const std::vector<Vec3>& wedge_normals)
    : mesh_(mesh),
      surface_(surface),
      face_normals_(face_normals),
      vertex_normals_(mesh.positions.size(), Vec3::Zero()),
      vertex_areas_(mesh.positions.size(), 0.0) {
  const std::vector<double> areas = wedge_areas(mesh);
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    vertex_areas_[mesh.wedge_vertex[w]] += areas[w];
    vertex_normals_[mesh.wedge_vertex[w]] += wedge_normals[w];
  }
  for (Vec3& normal : vertex_normals_) normal.normalize();
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
                               const std::vector<std::array<Index, 3>>& triangles) {
  from_result_.resize(triangles.size() * kRule.size());
  tbb::parallel_for(std::size_t{0}, triangles.size(), [&](std::size_t t) {
    const auto& corners = triangles[t];
    const Vec3& a = positions[corners[0]];
    const Vec3& b = positions[corners[1]];
    const Vec3& c = positions[corners[2]];
    const Vec3 cross = (b - a).cross(c - a);
    const double area2 = cross.norm();
    for (std::size_t s = 0; s < kRule.size(); ++s) {
      DistanceSample& own = from_result_[t * kRule.size() + s];
      const auto& at = kRule[s].at;
      const Vec3 place = at[0] * a + at[1] * b + at[2] * c;
      if (own.corners == corners && own.place == place) continue;
      // The first time the sample before is the best guess.
      const Index guess = own.nearest == kNone && s > 0
                              ? from_result_[t * kRule.size() + s - 1].nearest
                              : own.nearest;
      const ClosestPoint nearest = surface_.closest_near(place, guess);
      own = {place, nearest.distance, Vec3::Zero(), kRule[s].weight * area2 / 2, corners,
             at,    nearest.triangle};
      const Vec3& normal = face_normals_[nearest.triangle];
      if (!(normal.dot(cross) > kLeastAgreement * area2)) continue;
      set_way(own, surface_.point(nearest) - place, normal, kNoWay * mesh_.diagonal);
    }
  });
}

void Deviation::measure_surface(const std::vector<Vec3>& positions,
                                const std::vector<std::array<Index, 3>>& triangles) {
  const SurfaceDistance result(positions, triangles);
  const std::size_t step = mesh_.positions.size() / (kSurfaceSamples * triangles.size()) + 1;
  from_surface_.resize(mesh_.positions.size() / step);
  tbb::parallel_for(std::size_t{0}, from_surface_.size(), [&](std::size_t s) {
    const std::size_t v = s * step;
    const Vec3& place = mesh_.positions[v];
    DistanceSample& own = from_surface_[s];
    const ClosestPoint nearest = result.closest_near(place, own.nearest);
    const auto& corners = triangles[nearest.triangle];
    const Vec3& a = positions[corners[0]];
    const Vec3 cross = (positions[corners[1]] - a).cross(positions[corners[2]] - a);
    own = {
        place,   nearest.distance,    Vec3::Zero(),    vertex_areas_[v] * static_cast<double>(step),
        corners, nearest.barycentric, nearest.triangle};
    const Vec3& normal = vertex_normals_[v];
    if (!(normal.dot(cross) > kLeastAgreement * cross.norm())) return;
    set_way(own, place - result.point(nearest), normal, kNoWay * mesh_.diagonal);
  });
}

double Deviation::sum() const {
  double sum = 0;
  for (const auto* samples : {&from_result_, &from_surface_}) {
    for (const DistanceSample& s : *samples) sum += s.weight * s.distance * s.distance;
  }
  return sum;
}

double Deviation::cost() const {
  double sum = 0;
  for (const auto* samples : {&from_result_, &from_surface_}) {
    for (const DistanceSample& s : *samples) {
      sum += s.weight * s.distance * s.distance * (1 + std::abs(s.distance) * per_far_);
    }
  }
  return sum;
}

/// Slope of the cost over the squared distance, for an area of 1.
double Deviation::slope_of(const DistanceSample& sample) const {
  return 1 + 1.5 * std::abs(sample.distance) * per_far_;
}

double Deviation::mean() const {
  double area = 0;
  for (const auto* samples : {&from_result_, &from_surface_}) {
    for (const DistanceSample& s : *samples) area += s.weight;
  }
  return area > 0 ? sum() / area : 0.0;
}

void Deviation::add_to(BlockSystem& system) const {
  // The six samples of a triangle concern the same vertices: their sum is looked up once.
  for (std::size_t first = 0; first < from_result_.size(); first += kRule.size()) {
    TriangleTerms terms;
    for (std::size_t s = first; s < first + kRule.size(); ++s) {
      terms.add(from_result_[s], slope_of(from_result_[s]));
    }
    terms.add_to(system, from_result_[first].corners);
  }
  for (const DistanceSample& s : from_surface_) {
    TriangleTerms terms;
    terms.add(s, slope_of(s));
    terms.add_to(system, s.corners);
  }
}

}  // namespace strake::fitting
