#pragma once

#include <cstdint>

namespace strake {

/// Takes further bits into a hash, by the golden ratio (Knuth, volume 3, section 6.4).
/// \param hash  of what came before; 0 at first
inline std::uint64_t mix_bits(std::uint64_t hash, std::uint64_t bits) {
  hash = (hash ^ bits) * 0x9E3779B97F4A7C15U;
  return hash ^ hash >> 32U;
}

}  // namespace strake
