#pragma once

#include <cstdint>
#include <random>

#include "common/core/types.h"

namespace strake {

/// Uniform numbers that are the same on every platform (the standard's distributions are not).
class UniformRandom {
 public:
  explicit UniformRandom(std::uint64_t seed) : engine_(seed) {}
  /// \return a number in [-1, 1)
  double symmetric() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }
  /// \return a point in the cube [-1, 1)^3, its coordinates drawn one after the other: as arguments
  /// of
  ///         one call compilers would draw them in different orders
  Vec3 in_cube() {
    Vec3 point;
    for (const int axis : {2, 1, 0}) point[axis] = symmetric();
    return point;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace strake
