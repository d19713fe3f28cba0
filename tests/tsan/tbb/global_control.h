#pragma once

// See parallel_for.h beside this file.

#include <algorithm>
#include <cstddef>

#include "tests/tsan/tbb/info.h"

namespace tbb {

/// Limits the threads of loops while it lives; set by the thread that starts them.
class global_control {
 public:
  enum parameter { max_allowed_parallelism };

  global_control(parameter, std::size_t most) : before_(limit()) { limit() = most; }
  ~global_control() { limit() = before_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

  static std::size_t active_value(parameter) { return limit(); }

 private:
  static std::size_t& limit() {
    static std::size_t most = static_cast<std::size_t>(info::default_concurrency());
    return most;
  }

  std::size_t before_;
};

}  // namespace tbb
