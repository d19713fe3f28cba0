#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <complex>

#include "common/core/tri_mesh.h"

/// Tangent frames, transport between them, and directions with symmetries. Header only.
namespace strake {

/// Two unit vectors that complete the unit normal to a right-handed frame (x, y, normal).
struct TangentFrame {
  Vec3 x;
  Vec3 y;

  [[nodiscard]] Vec2 tangent_from_world(const Vec3& v) const { return {x.dot(v), y.dot(v)}; }
  [[nodiscard]] Vec3 world_from_tangent(const Vec2& t) const { return x * t.x() + y * t.y(); }
};

/// Any tangent frame of a unit normal; continuous except at normal.z = -0 (Duff et al. 2017).
inline TangentFrame tangent_frame(const Vec3& normal) {
  const double sign = std::copysign(1.0, normal.z());
  const double a = -1.0 / (sign + normal.z());
  const double b = normal.x() * normal.y() * a;
  return {Vec3(1.0 + sign * normal.x() * normal.x() * a, sign * b, -sign * normal.x()),
          Vec3(b, sign + normal.y() * normal.y() * a, -normal.y())};
}

/// Turns `v` by the smallest rotation that takes unit vector `from` to unit vector `to`.
/// Opposite vectors leave `v` unchanged.
inline Vec3 rotate_between(const Vec3& from, const Vec3& to, const Vec3& v) {
  const Vec3 axis = from.cross(to);
  const double c = from.dot(to);
  if (c < -1.0 + 1e-12) return v;
  return v * c + axis.cross(v) + axis * (axis.dot(v) / (1.0 + c));
}

/// The fourth power of a direction as a unit complex number: equal for all four arms of a cross.
inline std::complex<double> cross_power(const Vec2& direction) {
  const std::complex<double> z(direction.x(), direction.y());
  const double length = std::abs(z);
  if (!(length > 0)) return {0, 0};
  const std::complex<double> unit = z / length;
  const std::complex<double> square = unit * unit;
  return square * square;
}

/// One of the four directions whose cross_power is (a positive multiple of) `power`: the one
/// closest to `reference`, which must not be zero.
inline Vec2 cross_arm(std::complex<double> power, const Vec2& reference) {
  const double base = std::arg(power) / 4;
  const double wanted = std::atan2(reference.y(), reference.x());
  constexpr double kQuarter = M_PI / 2;
  const double angle = base + kQuarter * std::round((wanted - base) / kQuarter);
  return {std::cos(angle), std::sin(angle)};
}

/// Unit eigenvector directions and eigenvalues of a symmetric 2x2 matrix.
struct Eigen2 {
  double larger = 0;         ///< eigenvalue of larger magnitude
  double smaller = 0;        ///< the other one
  Vec2 direction_of_larger;  ///< unit; (1, 0) where the matrix is a multiple of the identity
};

/// Solves the symmetric 2x2 eigenproblem [xx xy; xy yy] by one rotation, without cancellation.
inline Eigen2 eigen_symmetric2(double xx, double xy, double yy) {
  const double mean = 0.5 * (xx + yy);
  const double half = 0.5 * (xx - yy);
  const double radius = std::hypot(half, xy);
  const double angle =
      radius > 0 ? 0.5 * std::atan2(xy, half) : 0.0;  // of the algebraically larger
  const double high = mean + radius;
  const double low = mean - radius;
  const bool high_is_larger = std::abs(high) >= std::abs(low);
  const Vec2 d(std::cos(angle), std::sin(angle));
  return high_is_larger ? Eigen2{high, low, d} : Eigen2{low, high, Vec2(-d.y(), d.x())};
}

/// The product of lengths and the sine of the angle from a to b.
inline double cross2(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

/// Normal of a face, as long as twice its area.
inline Vec3 face_cross(const TriMesh& mesh, Index face) {
  const auto& f = mesh.faces[face];
  const Vec3& a = mesh.positions[f[0]];
  return (mesh.positions[f[1]] - a).cross(mesh.positions[f[2]] - a);
}

inline double face_area(const TriMesh& mesh, Index face) {
  return 0.5 * face_cross(mesh, face).norm();
}

}  // namespace strake
