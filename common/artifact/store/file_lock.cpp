#include "common/artifact/store/file_lock.h"

#include <fcntl.h>

#include <cerrno>

namespace strake {
namespace {

/// \return whether that worked; else errno says why not
bool set_lock(int descriptor, off_t first, off_t count, short type) {
  struct flock range = {};
  range.l_type = type;
  range.l_whence = SEEK_SET;
  range.l_start = first;
  range.l_len = count;
  return ::fcntl(descriptor, F_OFD_SETLK, &range) == 0;
}

}  // namespace

LockOutcome try_lock(int descriptor, off_t first, off_t count) {
  if (set_lock(descriptor, first, count, F_WRLCK)) return LockOutcome::taken;
  const bool is_held = errno == EAGAIN || errno == EACCES;
  return is_held ? LockOutcome::held_by_others : LockOutcome::unsupported;
}

void unlock(int descriptor, off_t first, off_t count) {
  set_lock(descriptor, first, count, F_UNLCK);
}

}  // namespace strake
