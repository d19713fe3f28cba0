#pragma once

#include <functional>
#include <optional>

#include "common/core/types.h"
#include "common/geometry/samples/samples.h"

namespace strake::support {

/// What is known of a surface at a point.
struct ExactCurvature {
  Vec3 foot;            ///< the point of the surface that all this holds for
  Vec3 normal;          ///< unit, outward
  double k_min, k_max;  ///< 1/length, |k_min| <= |k_max|; positive where convex
  Vec3 t_min, t_max;    ///< unit, orthogonal to each other and the normal; sign free
  bool umbilic;         ///< k_min = k_max up to rounding: the directions mean nothing

  /// (|k_max| - |k_min|) / (|k_max| + |k_min|) in [0, 1]: how clear it is which family is which.
  [[nodiscard]] double anisotropy() const;
};

/// A function f whose zero set is the surface, negative inside, and its derivatives.
struct ImplicitValue {
  double value;
  Vec3 gradient;
  Mat3 hessian;
};

/// Two functions that describe the lines of curvature of a surface exactly.
struct LineCoordinates {
  double along_min;  ///< stays the same along lines of minimum curvature
  double along_max;  ///< stays the same along lines of maximum curvature
};

/// Ground truth: a surface given by an equation, with exact curvatures.
class AnalyticSurface {
 public:
  using Implicit = std::function<ImplicitValue(const Vec3&)>;
  using Lines = std::function<LineCoordinates(const Vec3&)>;

  explicit AnalyticSurface(Implicit implicit, Lines lines = nullptr)
      : implicit_(std::move(implicit)), lines_(std::move(lines)) {}

  /// Curvatures at the foot of a point on or near the surface (by Newton steps along the gradient,
  /// so it is the nearest point to first order).
  [[nodiscard]] ExactCurvature at(const Vec3& p) const;
  /// Zero on the surface, about the signed distance nearby.
  [[nodiscard]] double offset(const Vec3& p) const;
  /// Line coordinates of a point of the surface, where they are known. Angles are in (-pi, pi].
  [[nodiscard]] std::optional<LineCoordinates> lines(const Vec3& p) const;

 private:
  Implicit implicit_;
  Lines lines_;
};

/// The surface of a sample, the side of a closed cylinder.
/// \pre not the part, which has no one equation
AnalyticSurface analytic_surface(SampleKind kind);

}  // namespace strake::support
