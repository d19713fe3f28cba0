#pragma once

#include <chrono>
#include <cstddef>

#include "common/artifact/store/store.h"

namespace strake {

/// Records of runs that `strake run` leaves, newest first, however old they are.
inline constexpr std::size_t kKeptRuns = 50;
/// A record in which something was written since stays in any case: where a file system has no
/// locks nothing else tells that its run goes on.
inline constexpr std::chrono::hours kFreshRun{1};

/// Removes records of runs but for the newest `kKeptRuns`, so that they do not become more and
/// more. Those stay that may go on: a `RunFolder` whose lock is held, a fresh one, and one for a
/// cluster whose steps have not all ended, as jobs may wait for long.
void remove_surplus_runs(const Store& store);

/// Removes records of runs in which nothing has happened for a week, or for 90 days where steps
/// have not ended.
void remove_old_runs(const Store& store);

}  // namespace strake
