#pragma once

#include "common/core/types.h"

namespace strake::coarsening {

/// Weighted sum of squared distances from planes, as a function of a point (Garland & Heckbert
/// 1997).
struct PlaneQuadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
  double x = 0, y = 0, z = 0;
  double constant = 0;

  /// \param normal  unit  \param offset  the plane is normal . p + offset = 0
  void add_plane(const Vec3& normal, double offset, double weight) {
    const Vec3 n = weight * normal;
    xx += n.x() * normal.x();
    xy += n.x() * normal.y();
    xz += n.x() * normal.z();
    yy += n.y() * normal.y();
    yz += n.y() * normal.z();
    zz += n.z() * normal.z();
    x += n.x() * offset;
    y += n.y() * offset;
    z += n.z() * offset;
    constant += weight * offset * offset;
  }

  PlaneQuadric& operator+=(const PlaneQuadric& other) {
    xx += other.xx;
    xy += other.xy;
    xz += other.xz;
    yy += other.yy;
    yz += other.yz;
    zz += other.zz;
    x += other.x;
    y += other.y;
    z += other.z;
    constant += other.constant;
    return *this;
  }

  [[nodiscard]] double at(const Vec3& p) const {
    return p.x() * (xx * p.x() + 2 * (xy * p.y() + xz * p.z() + x)) +
           p.y() * (yy * p.y() + 2 * (yz * p.z() + y)) + p.z() * (zz * p.z() + 2 * z) + constant;
  }
};

}  // namespace strake::coarsening
