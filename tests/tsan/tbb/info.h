#pragma once

// See parallel_for.h beside this file.

#include <algorithm>
#include <thread>

namespace tbb::info {

/// At least two, or there would be nothing to find.
inline int default_concurrency() {
  return std::max(2, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace tbb::info
