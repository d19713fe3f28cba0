#pragma once

#include <array>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// The point of a surface nearest to a query point.
struct ClosestPoint {
  Index triangle = kNone;  ///< kNone: nothing within the distance asked for
  double distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> barycentric = {0, 0, 0};  ///< in `triangle`; each in [0, 1], sum 1
};

/// The point of one triangle nearest to `p`, in double precision; `triangle` of the result is left
/// at kNone. The triangle may be degenerate: a segment or a point.
ClosestPoint closest_point_on_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Nearest-point queries on a set of triangles.
///
/// Distances are exact up to double rounding: Embree's single precision hierarchy only finds
/// candidates, with a margin for its rounding. Degenerate triangles count as the segments or points
/// they are. Where several triangles are equally near, the least index is returned, so results do
/// not depend on how the hierarchy was built. Queries may run in parallel.
class SurfaceDistance {
 public:
  using Triangles = std::vector<std::array<Index, 3>>;

  /// \param positions, triangles  kept by reference; positions are finite where used, in any unit
  /// \throw PreconditionError where there is no triangle
  SurfaceDistance(const std::vector<Vec3>& positions, const Triangles& triangles);
  SurfaceDistance(std::vector<Vec3>&&, const Triangles&) = delete;
  SurfaceDistance(const std::vector<Vec3>&, Triangles&&) = delete;
  SurfaceDistance(std::vector<Vec3>&&, Triangles&&) = delete;
  SurfaceDistance(const SurfaceDistance&) = delete;
  SurfaceDistance& operator=(const SurfaceDistance&) = delete;
  ~SurfaceDistance();

  /// The nearest point of the surface.
  [[nodiscard]] ClosestPoint closest(const Vec3& p) const;
  /// The same, faster the nearer the point is to triangle `guess`; kNone: no guess.
  [[nodiscard]] ClosestPoint closest_near(const Vec3& p, Index guess) const;
  /// The nearest point that is at most `reach` away; faster the smaller that is.
  [[nodiscard]] ClosestPoint closest_within(const Vec3& p, double reach) const;

  /// The nearest point of those triangles that `accept` admits, at most `reach` away.
  [[nodiscard]] ClosestPoint closest_if(const Vec3& p, double reach,
                                        const std::function<bool(Index)>& accept) const;

  /// How far it is from a place of the surface through the body to its other side: to the first
  /// triangle that a ray meets of those that `accept` admits, if it is seen from behind; infinite
  /// where that is not, or is not within `reach`. In single precision, from a millionth of the size
  /// of the surface on.
  /// \param direction  unit
  /// \param least_cosine  of the angle between its normal and the ray, at least 0; where that is
  /// less the triangle is none that lies across
  [[nodiscard]] double distance_to_back(const Vec3& p, const Vec3& direction, double reach,
                                        double least_cosine,
                                        const std::function<bool(Index)>& accept) const;

  /// The place of a query's result.
  [[nodiscard]] Vec3 point(const ClosestPoint& at) const;

  [[nodiscard]] const std::vector<Vec3>& positions() const { return positions_; }
  [[nodiscard]] const Triangles& triangles() const { return triangles_; }

 private:
  struct Hierarchy;

  [[nodiscard]] ClosestPoint on_triangle(const Vec3& p, Index triangle) const;
  /// \param best  what is known already: the triangle kNone and a distance that is not exceeded, or
  ///              a point of the surface
  [[nodiscard]] ClosestPoint query(const Vec3& p, const ClosestPoint& best,
                                   const std::function<bool(Index)>* accept) const;

  const std::vector<Vec3>& positions_;
  const Triangles& triangles_;
  Vec3 centre_ = Vec3::Zero();
  double scale_ = 1;  // into the hierarchy's frame, where the triangles lie within [-1, 1]
  std::unique_ptr<Hierarchy> hierarchy_;
};

}  // namespace strake
