#pragma once

#include <optional>
#include <span>

#include "common/core/types.h"

namespace strake {

/// From where a model is looked at.
struct View {
  double azimuth_deg = 30;     ///< around the up axis; 0 looks against the model's front
  double elevation_deg = 20;   ///< above the horizon
  double zoom = 1;             ///< 1: the model fills the picture
  bool z_up = false;           ///< z instead of y is up
  std::optional<Vec3> target;  ///< the point in the middle of the picture; default: the model's
};

/// A perspective camera whose picture holds a set of points as large as they fit.
class Camera {
 public:
  /// \param points  at least one, in any frame; all of them come to lie in the picture at zoom 1
  Camera(std::span<const Vec3> points, const View& view, int width, int height);

  /// Looks from one point at another, with y up. \param fov_deg  of the picture's height
  Camera(const Vec3& position, const Vec3& target, double fov_deg, int width, int height);

  /// Unit direction of the ray through a place in the picture, in pixels from the top left corner.
  [[nodiscard]] Vec3 direction(double x, double y) const;
  /// Place in the picture of a point in front of the camera, pixels.
  [[nodiscard]] Vec2 project(const Vec3& point) const;
  /// Length of a pixel's side at a point's depth.
  [[nodiscard]] double pixel_size(const Vec3& point) const;

  [[nodiscard]] const Vec3& position() const { return position_; }
  [[nodiscard]] const Vec3& right() const { return right_; }
  [[nodiscard]] const Vec3& up() const { return up_; }
  [[nodiscard]] const Vec3& backward() const { return backward_; }

 private:
  Vec3 right_, up_, backward_;  // unit, world frame
  Vec3 position_;
  Vec2 middle_;     // film coordinates (tangents) of the picture's middle
  double tangent_;  // film length of a pixel's side
  Vec2 half_size_;  // of the picture, pixels
};

}  // namespace strake
