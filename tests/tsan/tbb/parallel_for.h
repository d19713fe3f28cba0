#pragma once

// What this project uses of oneTBB, on plain threads: the thread sanitizer sees no synchronisation
// within libtbb, which is built without it, and takes every loop for a race. Here a loop's threads
// begin and end with it, and nothing else orders what they do, so that it finds races between the
// bodies of our loops, and those only.

#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/tsan/tbb/blocked_range.h"
#include "tests/tsan/tbb/global_control.h"

namespace tbb {

namespace shim {

/// Whether this thread is within a loop already; loops within run on it alone.
inline thread_local bool is_inside = false;

/// Calls body(i) for each i below `count`, on as many threads as may be.
template <class Body>
void run(std::size_t count, const Body& body) {
  const std::size_t most = global_control::active_value(global_control::max_allowed_parallelism);
  if (is_inside || most < 2 || count < 2) {
    for (std::size_t i = 0; i < count; ++i) body(i);
    return;
  }
  const std::size_t count_of_threads = std::min(most, count);
  std::exception_ptr thrown;
  std::mutex guard;
  // Each has its share whatever the others' pace, or one might do everything, and nothing be found.
  const auto work = [&](std::size_t thread) {
    is_inside = true;
    try {
      for (std::size_t i = thread; i < count; i += count_of_threads) body(i);
    } catch (...) {
      const std::lock_guard lock(guard);
      if (!thrown) thrown = std::current_exception();
    }
    is_inside = false;
  };
  std::vector<std::thread> threads;
  for (std::size_t t = 1; t < count_of_threads; ++t) threads.emplace_back(work, t);
  work(0);
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace shim

template <class Index, class Body>
void parallel_for(Index first, Index last, const Body& body) {
  if (!(first < last)) return;
  constexpr std::size_t kPiece = 16;
  const auto count = static_cast<std::size_t>(last - first);
  const std::size_t piece = count <= kPiece ? 1 : kPiece;
  shim::run((count + piece - 1) / piece, [&](std::size_t p) {
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
      body(static_cast<Index>(first + static_cast<Index>(i)));
    }
  });
}

template <class Index, class Body>
void parallel_for(const blocked_range<Index>& range, const Body& body) {
  const auto count = static_cast<std::size_t>(range.end() - range.begin());
  const std::size_t grain = range.grainsize();
  shim::run((count + grain - 1) / grain, [&](std::size_t p) {
    body(blocked_range<Index>(
        static_cast<Index>(range.begin() + static_cast<Index>(p * grain)),
        static_cast<Index>(range.begin() + static_cast<Index>(std::min(count, (p + 1) * grain))),
        grain));
  });
}

}  // namespace tbb
