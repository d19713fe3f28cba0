#include "common/geometry/patch_fill/fill_polygon.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <utility>

#include "common/geometry/angles.h"

namespace strake {
namespace {

constexpr double kLeastAngle = 1 * kDegree;
constexpr double kSharpestTurn = 2;  ///< 1 - cosine

/// What is least.
struct Price {
  double turn = 0;
  double area = 0;

  [[nodiscard]] bool operator<(const Price& other) const {
    return std::pair(turn, area) < std::pair(other.turn, other.area);
  }
};

class PolygonFilling {
 public:
  PolygonFilling(const std::vector<Vec3>& corners, const std::vector<Vec3>& beyond)
      : corners_(corners),
        beyond_(beyond),
        parts_(corners.size() * corners.size(), Part{{}, kNothing}) {}

  std::vector<std::array<Index, 3>> run(
      const std::function<bool(std::size_t, std::size_t)>& may_join) {
    const std::size_t n = corners_.size();
    for (std::size_t gap = 2; gap < n; ++gap) {
      for (std::size_t i = 0; i + gap < n; ++i) {
        const std::size_t j = i + gap;
        if (gap + 1 == n || may_join(i, j)) choose(i, j);
      }
    }
    std::vector<std::array<Index, 3>> triangles;
    collect(0, n - 1, triangles);
    if (triangles.size() + 2 != n) triangles.clear();
    return triangles;
  }

 private:
  static constexpr std::size_t kNothing = std::numeric_limits<std::size_t>::max();

  /// The corners from i to j, filled.
  struct Part {
    Price price;
    std::size_t apex;  ///< of the triangle on the edge from i to j; kNothing: there is none
  };

  [[nodiscard]] const Part& part(std::size_t i, std::size_t j) const {
    return parts_[i * corners_.size() + j];
  }
  [[nodiscard]] bool is_filled(std::size_t i, std::size_t j) const {
    return j == i + 1 || part(i, j).apex != kNothing;
  }

  /// Unit; zero without an area.
  [[nodiscard]] Vec3 normal(std::size_t i, std::size_t m, std::size_t j) const {
    return cross(i, m, j).normalized();
  }
  [[nodiscard]] Vec3 cross(std::size_t i, std::size_t m, std::size_t j) const {
    return (corners_[m] - corners_[i]).cross(corners_[j] - corners_[i]);
  }

  /// Turn from a triangle to what lies beyond its edge from i to j.
  [[nodiscard]] double turn(const Vec3& from, std::size_t i, std::size_t j) const {
    const Vec3 to = j == i + 1 ? beyond_[i] : normal(i, part(i, j).apex, j);
    return to.isZero(0) ? 0 : 1 - from.dot(to);
  }

  void choose(std::size_t i, std::size_t j) {
    Part best{{}, kNothing};
    for (std::size_t m = i + 1; m < j; ++m) {
      if (!is_filled(i, m) || !is_filled(m, j)) continue;
      const Vec3 own = normal(i, m, j);
      Price price{std::max(turn(own, i, m), turn(own, m, j)), cross(i, m, j).norm() / 2};
      if (i == 0 && j + 1 == corners_.size() && !beyond_[j].isZero(0)) {
        price.turn = std::max(price.turn, 1 - own.dot(beyond_[j]));
      }
      if (smallest_angle(corners_[i], corners_[m], corners_[j]) < kLeastAngle)
        price.turn = kSharpestTurn;
      for (const Part& side : {part(i, m), part(m, j)}) {
        price.turn = std::max(price.turn, side.price.turn);
        price.area += side.price.area;
      }
      if (best.apex == kNothing || price < best.price) best = {price, m};
    }
    parts_[i * corners_.size() + j] = best;
  }

  void collect(std::size_t i, std::size_t j, std::vector<std::array<Index, 3>>& triangles) const {
    if (j == i + 1 || !is_filled(i, j)) return;
    const std::size_t m = part(i, j).apex;
    triangles.push_back({static_cast<Index>(i), static_cast<Index>(m), static_cast<Index>(j)});
    collect(i, m, triangles);
    collect(m, j, triangles);
  }

  const std::vector<Vec3>& corners_;
  const std::vector<Vec3>& beyond_;
  std::vector<Part> parts_;  ///< [n n]
};

}  // namespace

std::vector<std::array<Index, 3>> fill_polygon(
    const std::vector<Vec3>& corners, const std::vector<Vec3>& beyond,
    const std::function<bool(std::size_t, std::size_t)>& may_join) {
  return PolygonFilling(corners, beyond).run(may_join);
}

}  // namespace strake
