#pragma once

#include <chrono>
#include <cstddef>
#include <optional>

#include "common/artifact/store/store.h"

namespace strake {

/// Records of runs, which become more and more: one may be removed when nothing comes of it any
/// more. It stays where its run may go on: while a process holds its `FolderLock`, for `kFreshRun`
/// after something was written in it, as nothing else tells where a file system has no locks, and
/// one for a cluster until all its steps have ended or `kLongestQueue` has passed, as jobs wait.

/// Those that a run leaves, newest first, besides what may go on.
inline constexpr std::size_t kKeptRuns = 50;
/// Age from which on `strake gc` removes them, too.
inline constexpr std::chrono::hours kOldRun{7 * 24};
inline constexpr std::chrono::hours kFreshRun{1};
inline constexpr std::chrono::hours kLongestQueue{90 * 24};

/// Removes all but the newest `kKeptRuns`, and with a least age all from there on, too.
void remove_old_runs(const Store& store, std::optional<std::chrono::hours> from = std::nullopt);

}  // namespace strake
