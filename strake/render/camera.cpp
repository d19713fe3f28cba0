#include "strake/render/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace strake {
namespace {

constexpr double kHalfFieldOfView = 0.22;  // tangent, of the shorter side of the picture
constexpr double kMargin = 0.04;           // of the picture left free on each side

}  // namespace

Camera::Camera(std::span<const Vec3> points, const View& view, int width, int height)
    : half_size_(width / 2.0, height / 2.0) {
  const double azimuth = view.azimuth_deg * std::numbers::pi / 180;
  const double elevation = view.elevation_deg * std::numbers::pi / 180;
  const Vec3 world_up = view.z_up ? Vec3::UnitZ() : Vec3::UnitY();
  const Vec3 front = view.z_up ? Vec3(-Vec3::UnitY()) : Vec3::UnitZ();
  const Vec3 side = world_up.cross(front);
  right_ = std::cos(azimuth) * side - std::sin(azimuth) * front;
  const Vec3 level = std::cos(azimuth) * front + std::sin(azimuth) * side;
  backward_ = std::cos(elevation) * level + std::sin(elevation) * world_up;
  up_ = backward_.cross(right_);

  // The nearest position from which every point lies inside the four planes of the frustum: with
  // slope t, |x - cx| <= t (cz - z) for all points gives two bounds per axis.
  const double per_pixel = kHalfFieldOfView / half_size_.minCoeff();
  const Vec2 slope = per_pixel * (1 - 2 * kMargin) * half_size_;
  Vec2 most = Vec2::Constant(-std::numeric_limits<double>::infinity());
  Vec2 least = most;
  double nearest = most.x();
  for (const Vec3& p : points) {
    const Vec2 film(right_.dot(p), up_.dot(p));
    const double z = backward_.dot(p);
    most = most.cwiseMax(film + slope * z);
    least = least.cwiseMax(-film + slope * z);
    nearest = std::max(nearest, z);
  }
  const Vec2 centre = (most - least) / 2;
  const double fit = ((most + least) / 2).cwiseQuotient(slope).maxCoeff();
  const double depth = std::max(fit, nearest + 1e-6 * std::max(1.0, std::abs(nearest)));
  position_ = centre.x() * right_ + centre.y() * up_ + depth * backward_;

  tangent_ = per_pixel / view.zoom;
  middle_ = Vec2::Zero();
  if (view.target) {
    const Vec3 to_target = *view.target - position_;
    const double away = std::max(-backward_.dot(to_target), 1e-9);
    middle_ = Vec2(right_.dot(to_target), up_.dot(to_target)) / away;
  }
}

Camera::Camera(const Vec3& position, const Vec3& target, double fov_deg, int width, int height)
    : backward_((position - target).normalized()),
      position_(position),
      middle_(Vec2::Zero()),
      half_size_(width / 2.0, height / 2.0) {
  right_ = Vec3::UnitY().cross(backward_);
  right_ = right_.norm() > 1e-9 ? right_.normalized() : Vec3::UnitX();
  up_ = backward_.cross(right_);
  tangent_ = std::tan(fov_deg / 2 * std::numbers::pi / 180) / half_size_.y();
}

Vec3 Camera::direction(double x, double y) const {
  const double u = middle_.x() + (x - half_size_.x()) * tangent_;
  const double v = middle_.y() - (y - half_size_.y()) * tangent_;
  return (u * right_ + v * up_ - backward_).normalized();
}

Vec2 Camera::project(const Vec3& point) const {
  const Vec3 to_point = point - position_;
  const double away = std::max(-backward_.dot(to_point), 1e-9);
  const Vec2 film = Vec2(right_.dot(to_point), up_.dot(to_point)) / away - middle_;
  return half_size_ + Vec2(film.x(), -film.y()) / tangent_;
}

double Camera::pixel_size(const Vec3& point) const {
  return tangent_ * std::max(-backward_.dot(point - position_), 0.0);
}

}  // namespace strake
