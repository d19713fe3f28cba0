#pragma once

#include <sys/types.h>

namespace strake {

/// What came of asking for a lock.
enum class LockOutcome {
  taken,
  held_by_others,
  unsupported,  ///< the file system has no locks, as some that machines share
};

/// Asks, without waiting, for the exclusive lock of a part of a file. The kernel gives it up when
/// the last descriptor of this opening of the file is closed, however that happens.
/// \param descriptor  of a file open for writing
/// \param first       offset in bytes
/// \param count       bytes; 0: all that follow
LockOutcome try_lock(int descriptor, off_t first, off_t count);

/// Gives such a lock up.
void unlock(int descriptor, off_t first, off_t count);

}  // namespace strake
