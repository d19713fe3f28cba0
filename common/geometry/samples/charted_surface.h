#pragma once

#include <memory>

#include "common/core/types.h"

namespace strake {

/// A smooth surface with a chart: a map of the piece in use to the plane, nearly conformal, so that
/// a Delaunay triangulation of the chart is a good one of the surface.
class ChartedSurface {
 public:
  virtual ~ChartedSurface() = default;
  /// The point of the surface near `p` (exactly on it up to rounding, not always the nearest).
  [[nodiscard]] virtual Vec3 project(const Vec3& p) const = 0;
  /// Unit outward normal at a point of the surface.
  [[nodiscard]] virtual Vec3 normal(const Vec3& p) const = 0;
  [[nodiscard]] virtual Vec2 flatten(const Vec3& p) const = 0;
  [[nodiscard]] virtual Vec3 lift(const Vec2& q) const = 0;
};

using SurfacePtr = std::shared_ptr<const ChartedSurface>;

/// A right-handed orthonormal frame.
struct Frame {
  Vec3 origin = Vec3::Zero();
  Vec3 x = Vec3::UnitX();
  Vec3 y = Vec3::UnitY();
  Vec3 z = Vec3::UnitZ();

  /// The frame with the given axis z, and x as near as possible to `towards`.
  static Frame along(const Vec3& origin, const Vec3& axis, const Vec3& towards);
  [[nodiscard]] Vec3 to_local(const Vec3& p) const {
    const Vec3 d = p - origin;
    return {d.dot(x), d.dot(y), d.dot(z)};
  }
  [[nodiscard]] Vec3 to_world(const Vec3& p) const {
    return origin + p.x() * x + p.y() * y + p.z() * z;
  }
  [[nodiscard]] Vec3 turn_to_world(const Vec3& v) const {
    return v.x() * x + v.y() * y + v.z() * z;
  }
};

/// Which side of a surface is outside: away from its axis or middle, or towards it (a bore).
enum class Side { away, towards };

/// The plane z = 0 of the frame; outside is +z.
SurfacePtr plane_surface(const Frame& frame);
/// Around the frame's axis z; the chart is a ring around the origin.
SurfacePtr cylinder_surface(const Frame& frame, double radius, Side side);
/// A strip of a cylinder of less than half a turn about the frame's x; the chart is isometric.
SurfacePtr cylinder_strip(const Frame& frame, double radius, Side side);
/// A cone around the axis z of radius `radius + slope z`, slope != 0.
SurfacePtr cone_surface(const Frame& frame, double radius, double slope, Side side);
/// The half of a torus around the axis z that is further from the axis than its core circle, or
/// nearer to it (`inner`). The chart is conformal, a ring.
SurfacePtr torus_surface(const Frame& frame, double major, double minor, bool inner, Side side);
/// (x / axes_x)^2 + ... = 1; the chart covers all but the pole at -z of the frame.
/// \pre the frame's axes are those of the world up to order and sign
SurfacePtr ellipsoid_surface(const Frame& frame, const Vec3& axes);
/// (x^2 + y^2) / waist^2 - (z / slope)^2 = 1; the chart is a ring.
SurfacePtr hyperboloid_surface(double waist, double slope);
/// z = bend (x^2 - y^2); the chart is (x, y).
SurfacePtr saddle_surface(double bend);

}  // namespace strake
