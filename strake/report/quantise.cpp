#include "strake/report/quantise.h"

#include <algorithm>
#include <cmath>

namespace strake::report {
namespace {

constexpr double kLargest16 = 65535;
constexpr double kAsinhSteps = 1024;
constexpr double kLargestSigned = 32767;
constexpr double kLargestByte = 127;

}  // namespace

Grid::Grid(const std::vector<Vec3>& points) {
  if (points.empty()) return;
  low_ = points.front();
  Vec3 high = points.front();
  for (const Vec3& p : points) {
    low_ = low_.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double longest = (high - low_).maxCoeff();
  if (longest > 0) step_ = longest / kLargest16;
}

GridPoint Grid::quantise(const Vec3& point, std::uint16_t extra) const {
  GridPoint result = {0, 0, 0, extra};
  for (int k = 0; k < 3; ++k) {
    const double steps = std::round((point[k] - low_[k]) / step_);
    result[k] = static_cast<std::uint16_t>(std::clamp(steps, 0.0, kLargest16));
  }
  return result;
}

std::uint16_t quantise_share(double value) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * kLargest16));
}

std::int16_t quantise_signed(double value) {
  const double steps = std::asinh(value) * kAsinhSteps;
  return static_cast<std::int16_t>(std::lround(std::clamp(steps, -kLargestSigned, kLargestSigned)));
}

std::array<std::int8_t, 2> quantise_direction(const Vec3& unit) {
  const double sum = unit.cwiseAbs().sum();
  Vec2 folded = unit.head<2>() / sum;
  if (unit.z() < 0) {
    const Vec2 turned = Vec2::Ones() - Vec2(std::abs(folded.y()), std::abs(folded.x()));
    folded = {std::copysign(turned.x(), folded.x()), std::copysign(turned.y(), folded.y())};
  }
  return {static_cast<std::int8_t>(std::lround(folded.x() * kLargestByte)),
          static_cast<std::int8_t>(std::lround(folded.y() * kLargestByte))};
}

std::vector<std::array<std::uint8_t, 4>> quantise_colours(const std::vector<Colour>& colours) {
  std::vector<std::array<std::uint8_t, 4>> bytes(colours.size());
  for (std::size_t i = 0; i < colours.size(); ++i) {
    for (std::size_t k = 0; k < 4; ++k) {
      bytes[i][k] =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(colours[i][k], 0.0, 1.0)));
    }
  }
  return bytes;
}

}  // namespace strake::report
