#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/attributes.h"
#include "common/core/types.h"

/// Numbers in few bits, for display. The inverse of each is in viewer/src/decode.js.
namespace strake::report {

/// A point as multiples of a grid's step, and one more number of the same size.
using GridPoint = std::array<std::uint16_t, 4>;

/// 65536 steps along the longest side of a box; the same step along all sides.
class Grid {
 public:
  /// \param points  any length unit; may be empty
  explicit Grid(const std::vector<Vec3>& points);

  /// Within half a step of the point along each axis. \param extra  carried along
  [[nodiscard]] GridPoint quantise(const Vec3& point, std::uint16_t extra = 0) const;
  [[nodiscard]] const Vec3& low() const { return low_; }
  [[nodiscard]] double step() const { return step_; }

 private:
  Vec3 low_ = Vec3::Zero();
  double step_ = 1;
};

/// [0, 1] to 16 bits, within 1 / 131070; values outside are cut off.
std::uint16_t quantise_share(double value);

/// A signed number of any size to 16 bits: asinh(value) in steps of 1/1024, so within 0.05 % for
/// large values and 1/2048 for small ones. Beyond asinh(value) = 31.99 it is cut off.
std::int16_t quantise_signed(double value);

/// A unit vector to two bytes by the octahedral map, within 1 degree.
std::array<std::int8_t, 2> quantise_direction(const Vec3& unit);

/// Red, green, blue and opacity in 0 to 255 each.
std::vector<std::array<std::uint8_t, 4>> quantise_colours(const std::vector<Colour>& colours);

}  // namespace strake::report
