#pragma once

#include <cstdint>
#include <random>

namespace strake {

/// Uniform numbers that are the same on every platform (the standard's distributions are not).
class UniformRandom {
 public:
  explicit UniformRandom(std::uint64_t seed) : engine_(seed) {}
  /// \return a number in [-1, 1)
  double symmetric() { return 2 * (static_cast<double>(engine_() >> 11) * 0x1p-53) - 1; }

 private:
  std::mt19937_64 engine_;
};

}  // namespace strake
