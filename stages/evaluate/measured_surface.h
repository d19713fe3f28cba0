#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/surface_distance/surface_distance.h"

namespace strake::evaluation {

/// A place on a surface with the normal of its triangle.
struct SurfaceSample {
  Vec3 position;
  Vec3 normal;     ///< unit
  Index triangle;  ///< by its index in `distance()`
};

/// Triangles to measure on: area-weighted samples from them, nearest points on them.
///
/// Triangles without area (see `is_flat_triangle`) are left out: they have no normal, and where
/// their neighbours do not cover the same place there is nothing to see.
class MeasuredSurface {
 public:
  /// \param positions, triangles  kept by reference
  /// \throw PreconditionError naming `what` where no triangle has an area
  MeasuredSurface(const std::vector<Vec3>& positions,
                  const std::vector<std::array<Index, 3>>& triangles, const char* what);

  /// Sample i of n: the area is walked in n equal steps, with a low-discrepancy place in each, so
  /// that a sum over all of them converges faster than with random points. Depends on i and n only.
  [[nodiscard]] SurfaceSample sample(std::int64_t i, std::int64_t n) const;

  /// The vertices of triangles with an area, ascending by number.
  [[nodiscard]] std::vector<Vec3> vertices() const;

  [[nodiscard]] const SurfaceDistance& distance() const { return distance_; }
  /// Unit normal of a triangle, by its index in `distance()`.
  [[nodiscard]] Vec3 normal(Index triangle) const { return cross(triangle).normalized(); }
  /// Index among the triangles given, of one in `distance()`.
  [[nodiscard]] Index source(Index triangle) const {
    return sources_.empty() ? triangle : sources_[triangle];
  }
  [[nodiscard]] double area() const { return area_up_to_.back(); }
  /// The component of a triangle, joined by vertices, by its index in `distance()`.
  [[nodiscard]] Index component(Index triangle) const {
    return component_[distance_.triangles()[triangle][0]];
  }
  /// Whether all triangles are of one.
  [[nodiscard]] bool is_one() const { return is_one_; }

 private:
  [[nodiscard]] Vec3 cross(Index triangle) const;

  std::vector<Index> sources_;  // empty where none was left out, as `kept_`
  std::vector<std::array<Index, 3>> kept_;
  std::vector<double> area_up_to_;  // running sums
  SurfaceDistance distance_;
  std::vector<Index> component_;  // [V], each named by its first vertex
  bool is_one_ = true;
};

}  // namespace strake::evaluation
