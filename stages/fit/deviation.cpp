#include "stages/fit/deviation.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

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
constexpr double kBoundMargin = 1e-9;  ///< keeps rounding from making a bound too tight
/// Shorter ways, as a share of the diagonal, have no direction of their own.
constexpr double kNoWay = 1e-12;
/// Samples of the surface for each triangle of the result, at most.
constexpr std::size_t kSurfaceSamples = 4;

/// Fills in distance and direction. \param way  from the result to the surface
void set_way(DistanceSample& sample, const Vec3& way, const Vec3& normal, double shortest) {
  const double length = way.norm();
  sample.direction =
      length > shortest ? Vec3(std::copysign(1 / length, way.dot(normal)) * way) : normal;
  sample.distance = way.dot(sample.direction);
}

}  // namespace

Deviation::Deviation(const TriMesh& mesh, const SurfaceDistance& surface)
    : mesh_(mesh),
      surface_(surface),
      face_normals_(face_normals(mesh)),
      vertex_normals_(mesh.positions.size(), Vec3::Zero()),
      vertex_areas_(mesh.positions.size(), 0.0) {
  const std::vector<double> areas = wedge_areas(mesh);
  const std::vector<Vec3> normals = wedge_normals(mesh, face_normals_);
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    vertex_areas_[mesh.wedge_vertex[w]] += areas[w];
    vertex_normals_[mesh.wedge_vertex[w]] += normals[w];
  }
  for (Vec3& normal : vertex_normals_) normal.normalize();
}

void Deviation::measure(const std::vector<Vec3>& positions,
                        const std::vector<std::array<Index, 3>>& triangles) {
  measure_result(positions, triangles);
  measure_surface(positions, triangles);
}

void Deviation::measure_result(const std::vector<Vec3>& positions,
                               const std::vector<std::array<Index, 3>>& triangles) {
  if (from_result_.empty()) {
    DistanceSample unknown;
    unknown.distance = std::numeric_limits<double>::infinity();
    from_result_.assign(triangles.size() * kRule.size(), unknown);
  }
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
      // No farther than the last distance and the way since then.
      const double bound = std::abs(own.distance) + (place - own.place).norm();
      const ClosestPoint nearest = surface_.closest_within(
          place, (1 + kBoundMargin) * bound + kBoundMargin * mesh_.diagonal);
      own = {place, nearest.distance, Vec3::Zero(), kRule[s].weight * area2 / 2, corners, at};
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
    const ClosestPoint nearest = result.closest(place);
    const auto& corners = triangles[nearest.triangle];
    const Vec3& a = positions[corners[0]];
    const Vec3 cross = (positions[corners[1]] - a).cross(positions[corners[2]] - a);
    DistanceSample& own = from_surface_[s];
    own = {place,   nearest.distance,   Vec3::Zero(), vertex_areas_[v] * static_cast<double>(step),
           corners, nearest.barycentric};
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

double Deviation::mean() const {
  double area = 0;
  for (const auto* samples : {&from_result_, &from_surface_}) {
    for (const DistanceSample& s : *samples) area += s.weight;
  }
  return area > 0 ? sum() / area : 0.0;
}

void Deviation::add_to(BlockSystem& system) const {
  for (const auto* samples : {&from_result_, &from_surface_}) {
    for (const DistanceSample& s : *samples) {
      const Mat3 along = s.weight * s.direction * s.direction.transpose();
      for (int i = 0; i < 3; ++i) {
        system.add_right(s.corners[i], s.weight * s.at[i] * s.distance * s.direction);
        for (int j = 0; j < 3; ++j) {
          system.add(s.corners[i], s.corners[j], s.at[i] * s.at[j] * along);
        }
      }
    }
  }
}

}  // namespace strake::fitting
