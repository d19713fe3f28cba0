// For programs that this is loaded into before all else (LD_PRELOAD): their file systems have no
// locks.

#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <cstdarg>

namespace {

constexpr int kSetLock = 37;  // F_OFD_SETLK of <fcntl.h>, which declares what is defined here

int control(int descriptor, int command, void* argument) {
  if (command != kSetLock) {
    return static_cast<int>(::syscall(SYS_fcntl, descriptor, command, argument));
  }
  errno = ENOLCK;
  return -1;
}

}  // namespace

extern "C" {

int fcntl(int descriptor, int command, ...) {
  std::va_list rest;
  va_start(rest, command);
  void* argument = va_arg(rest, void*);
  va_end(rest);
  return control(descriptor, command, argument);
}

/// The same by the name that it has where files may be large.
int fcntl64(int descriptor, int command, ...) __attribute__((alias("fcntl")));
}
