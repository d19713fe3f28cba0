#include "common/geometry/samples/charted_surface.h"

#include <Eigen/Geometry>
#include <cmath>

namespace strake {
namespace {

Vec2 on_ring(double log_radius, double x, double y) {
  return Vec2(x, y).normalized() * std::exp(log_radius);
}

class Plane : public ChartedSurface {
 public:
  explicit Plane(const Frame& frame) : frame_(frame) {}
  Vec3 project(const Vec3& p) const override { return lift(flatten(p)); }
  Vec3 normal(const Vec3& /*p*/) const override { return frame_.z; }
  Vec2 flatten(const Vec3& p) const override { return frame_.to_local(p).head<2>(); }
  Vec3 lift(const Vec2& q) const override { return frame_.to_world({q.x(), q.y(), 0}); }

 private:
  Frame frame_;
};

class Cylinder : public ChartedSurface {
 public:
  Cylinder(const Frame& frame, double radius, Side side, bool strip)
      : frame_(frame), radius_(radius), sign_(side == Side::away ? 1 : -1), strip_(strip) {}

  Vec3 project(const Vec3& p) const override {
    Vec3 local = frame_.to_local(p);
    local.head<2>() *= radius_ / local.head<2>().norm();
    return frame_.to_world(local);
  }
  Vec3 normal(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    return sign_ * frame_.turn_to_world(Vec3(local.x(), local.y(), 0).normalized());
  }
  Vec2 flatten(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    if (strip_) return {radius_ * std::atan2(local.y(), local.x()), local.z()};
    return on_ring(local.z() / radius_, local.x(), local.y());
  }
  Vec3 lift(const Vec2& q) const override {
    const double angle = strip_ ? q.x() / radius_ : std::atan2(q.y(), q.x());
    const double z = strip_ ? q.y() : radius_ * std::log(q.norm());
    return frame_.to_world({radius_ * std::cos(angle), radius_ * std::sin(angle), z});
  }

 private:
  Frame frame_;
  double radius_, sign_;
  bool strip_;
};

class Cone : public ChartedSurface {
 public:
  Cone(const Frame& frame, double radius, double slope, Side side)
      : frame_(frame), radius_(radius), slope_(slope), sign_(side == Side::away ? 1 : -1) {}

  Vec3 project(const Vec3& p) const override {
    Vec3 local = frame_.to_local(p);
    // Within the half-plane through the axis: the foot on the line r = radius + slope z.
    const double r = local.head<2>().norm();
    const double z = (local.z() + slope_ * (r - radius_)) / (1 + slope_ * slope_);
    local.head<2>() *= (radius_ + slope_ * z) / r;
    local.z() = z;
    return frame_.to_world(local);
  }
  Vec3 normal(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    const Vec2 radial = local.head<2>().normalized();
    return sign_ * frame_.turn_to_world(Vec3(radial.x(), radial.y(), -slope_).normalized());
  }
  Vec2 flatten(const Vec3& p) const override { return frame_.to_local(p).head<2>(); }
  Vec3 lift(const Vec2& q) const override {
    return frame_.to_world({q.x(), q.y(), (q.norm() - radius_) / slope_});
  }

 private:
  Frame frame_;
  double radius_, slope_, sign_;
};

class Torus : public ChartedSurface {
 public:
  // `angle` runs around the tube, from the middle of the half in use: there r = major + reach,
  // with reach = +-minor, so r(angle) = major + reach cos(angle), z = minor sin(angle).
  Torus(const Frame& frame, double major, double minor, bool inner, Side side)
      : frame_(frame),
        major_(major),
        minor_(minor),
        reach_(inner ? -minor : minor),
        sign_(side == Side::away ? 1 : -1),
        rate_(2 * minor / std::sqrt(major * major - minor * minor)),
        squeeze_(std::sqrt((major - reach_) / (major + reach_))) {}

  Vec3 project(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    const Vec2 radial = local.head<2>().normalized();
    const Vec2 tube = Vec2(local.head<2>().norm() - major_, local.z()).normalized() * minor_;
    return frame_.to_world(
        {radial.x() * (major_ + tube.x()), radial.y() * (major_ + tube.x()), tube.y()});
  }
  Vec3 normal(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    const Vec2 radial = local.head<2>().normalized();
    const Vec3 core(radial.x() * major_, radial.y() * major_, 0);
    return sign_ * frame_.turn_to_world((local - core).normalized());
  }
  Vec2 flatten(const Vec3& p) const override {
    const Vec3 local = frame_.to_local(p);
    const double out = (local.head<2>().norm() - major_) * (reach_ > 0 ? 1 : -1);
    const double angle = std::atan2(local.z(), out);
    // Conformal: the integral of minor d(angle) / (major + reach cos(angle)).
    return on_ring(rate_ * std::atan(squeeze_ * std::tan(angle / 2)), local.x(), local.y());
  }
  Vec3 lift(const Vec2& q) const override {
    const double angle = 2 * std::atan(std::tan(std::log(q.norm()) / rate_) / squeeze_);
    const Vec2 r = q.normalized() * (major_ + reach_ * std::cos(angle));
    return frame_.to_world({r.x(), r.y(), minor_ * std::sin(angle)});
  }

 private:
  Frame frame_;
  double major_, minor_, reach_, sign_, rate_, squeeze_;
};

class Ellipsoid : public ChartedSurface {
 public:
  Ellipsoid(const Frame& frame, const Vec3& axes) : frame_(frame), axes_(axes) {}

  Vec3 project(const Vec3& p) const override { return p / p.cwiseQuotient(axes_).norm(); }
  Vec3 normal(const Vec3& p) const override {
    return p.cwiseQuotient(axes_).cwiseQuotient(axes_).normalized();
  }
  // Stereographic from the pole -z of the frame, after squeezing to the unit sphere.
  Vec2 flatten(const Vec3& p) const override {
    const Vec3 unit = frame_.to_local(p.cwiseQuotient(axes_));
    return unit.head<2>() / (1 + unit.z());
  }
  Vec3 lift(const Vec2& q) const override {
    const double square = q.squaredNorm();
    const Vec3 unit(2 * q.x() / (1 + square), 2 * q.y() / (1 + square),
                    (1 - square) / (1 + square));
    return project(frame_.to_world(unit).cwiseProduct(axes_));
  }

 private:
  Frame frame_;
  Vec3 axes_;
};

class Hyperboloid : public ChartedSurface {
 public:
  Hyperboloid(double waist, double slope) : waist_(waist), slope_(slope) {}

  Vec3 project(const Vec3& p) const override {
    const double radius = waist_ * std::hypot(1.0, p.z() / slope_);
    const Vec2 r = p.head<2>().normalized() * radius;
    return {r.x(), r.y(), p.z()};
  }
  Vec3 normal(const Vec3& p) const override {
    const double a2 = waist_ * waist_, c2 = slope_ * slope_;
    return Vec3(p.x() / a2, p.y() / a2, -p.z() / c2).normalized();
  }
  // With z = slope sinh(t) a step dt is about as long as a turn by dt: conformal enough.
  Vec2 flatten(const Vec3& p) const override {
    return on_ring(1.2 * std::asinh(p.z() / slope_), p.x(), p.y());
  }
  Vec3 lift(const Vec2& q) const override {
    return project({q.x(), q.y(), slope_ * std::sinh(std::log(q.norm()) / 1.2)});
  }

 private:
  double waist_, slope_;
};

class Saddle : public ChartedSurface {
 public:
  explicit Saddle(double bend) : bend_(bend) {}
  Vec3 project(const Vec3& p) const override { return lift(p.head<2>()); }
  Vec3 normal(const Vec3& p) const override {
    return Vec3(-2 * bend_ * p.x(), 2 * bend_ * p.y(), 1).normalized();
  }
  Vec2 flatten(const Vec3& p) const override { return p.head<2>(); }
  Vec3 lift(const Vec2& q) const override {
    return {q.x(), q.y(), bend_ * (q.x() * q.x() - q.y() * q.y())};
  }

 private:
  double bend_;
};

}  // namespace

Frame Frame::along(const Vec3& origin, const Vec3& axis, const Vec3& towards) {
  Frame frame;
  frame.origin = origin;
  frame.z = axis.normalized();
  frame.x = (towards - towards.dot(frame.z) * frame.z).normalized();
  frame.y = frame.z.cross(frame.x);
  return frame;
}

SurfacePtr plane_surface(const Frame& frame) { return std::make_shared<Plane>(frame); }
SurfacePtr cylinder_surface(const Frame& frame, double radius, Side side) {
  return std::make_shared<Cylinder>(frame, radius, side, false);
}
SurfacePtr cylinder_strip(const Frame& frame, double radius, Side side) {
  return std::make_shared<Cylinder>(frame, radius, side, true);
}
SurfacePtr cone_surface(const Frame& frame, double radius, double slope, Side side) {
  return std::make_shared<Cone>(frame, radius, slope, side);
}
SurfacePtr torus_surface(const Frame& frame, double major, double minor, bool inner, Side side) {
  return std::make_shared<Torus>(frame, major, minor, inner, side);
}
SurfacePtr ellipsoid_surface(const Frame& frame, const Vec3& axes) {
  return std::make_shared<Ellipsoid>(frame, axes);
}
SurfacePtr hyperboloid_surface(double waist, double slope) {
  return std::make_shared<Hyperboloid>(waist, slope);
}
SurfacePtr saddle_surface(double bend) { return std::make_shared<Saddle>(bend); }

}  // namespace strake
