#include "common/geometry/face_crossings/exact_predicates.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

namespace strake {
namespace {

constexpr double kRounding = std::numeric_limits<double>::epsilon() / 2;
// Shewchuk's bounds on the error of the determinants as computed, relative to their permanents.
constexpr double kBound3 = (7 + 56 * kRounding) * kRounding;
constexpr double kBound2 = (3 + 16 * kRounding) * kRounding;

int sign(double x) { return (x > 0) - (x < 0); }

/// A sum of doubles without rounding: parts that do not overlap, in ascending order of size.
/// Of as many as `orientation` adds: four determinants of six products of four parts each.
class ExactSum {
 public:
  void add(double x) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < count_; ++i) {
      const double part = parts_[i];
      const double sum = x + part;
      const double of_part = sum - x;
      const double rest = (x - (sum - of_part)) + (part - of_part);
      if (rest != 0) parts_[kept++] = rest;
      x = sum;
    }
    if (x != 0) parts_[kept++] = x;
    count_ = kept;
  }
  void add_product(double a, double b) {
    const double product = a * b;
    add(std::fma(a, b, -product));
    add(product);
  }
  void add_product(double a, double b, double c) {
    const double product = a * b;
    add_product(std::fma(a, b, -product), c);
    add_product(product, c);
  }
  [[nodiscard]] int sign() const { return count_ == 0 ? 0 : strake::sign(parts_[count_ - 1]); }

 private:
  static constexpr std::size_t kMostParts = 4 * 6 * 4;

  std::array<double, kMostParts> parts_;  // NOLINT: what is not counted is never read
  std::size_t count_ = 0;
};

/// Adds factor * det(a, b, c), factor being 1 or -1.
void add_determinant(ExactSum& sum, double factor, const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const int k = (i + 2) % 3;
    sum.add_product(factor * a[i], b[j], c[k]);
    sum.add_product(-factor * a[i], b[k], c[j]);
  }
}

}  // namespace

int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Vec3 ad = a - d;
  const Vec3 bd = b - d;
  const Vec3 cd = c - d;
  const double determinant = ad.dot(bd.cross(cd));
  const Vec3 x = ad.cwiseAbs();
  const Vec3 y = bd.cwiseAbs();
  const Vec3 z = cd.cwiseAbs();
  const double permanent = x[0] * (y[1] * z[2] + y[2] * z[1]) + x[1] * (y[2] * z[0] + y[0] * z[2]) +
                           x[2] * (y[0] * z[1] + y[1] * z[0]);
  if (std::abs(determinant) > kBound3 * permanent) return sign(determinant);
  if (permanent == 0) return 0;  // each product has a factor that is exactly 0
  ExactSum sum;
  add_determinant(sum, 1, a, b, c);
  add_determinant(sum, -1, a, b, d);
  add_determinant(sum, 1, a, c, d);
  add_determinant(sum, -1, b, c, d);
  return sum.sign();
}

int orientation(const Vec2& a, const Vec2& b, const Vec2& c) {
  const double left = (a.x() - c.x()) * (b.y() - c.y());
  const double right = (a.y() - c.y()) * (b.x() - c.x());
  const double determinant = left - right;
  if (std::abs(determinant) > kBound2 * (std::abs(left) + std::abs(right))) {
    return sign(determinant);
  }
  ExactSum sum;
  const auto add = [&sum](const Vec2& p, const Vec2& q) {
    sum.add_product(p.x(), q.y());
    sum.add_product(-p.y(), q.x());
  };
  add(a, b);
  add(b, c);
  add(c, a);
  return sum.sign();
}

}  // namespace strake
