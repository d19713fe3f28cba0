#include "common/artifact/store/folder_lock.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

#include "common/artifact/store/file_lock.h"
#include "common/core/error.h"

namespace strake {

namespace fs = std::filesystem;

FolderLock::FolderLock(const fs::path& folder) {
  const fs::path file = folder / "lock";
  // Somebody may remove the folder at any moment, even between these two steps, but not every time.
  constexpr int kAttempts = 100;
  for (int attempt = 0; attempt < kAttempts && descriptor_ < 0; ++attempt) {
    std::error_code ignored;  // told by what follows
    fs::create_directories(folder, ignored);
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0 && errno != ENOENT) break;
  }
  if (descriptor_ < 0) {
    throw InputError("store: cannot write '" + folder.string() + "': " + std::strerror(errno) +
                     "; free space, check the rights, or use another store");
  }
  const LockOutcome outcome = try_lock(descriptor_, 0, 0);
  if (outcome == LockOutcome::held_by_others) return;
  exclusive_ = outcome == LockOutcome::taken;
  // Somebody may have removed the folder, and with it this file, before the lock was taken.
  struct stat mine = {};
  struct stat present = {};
  held_ = ::fstat(descriptor_, &mine) == 0 && ::stat(file.c_str(), &present) == 0 &&
          mine.st_ino == present.st_ino;
}

FolderLock::~FolderLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

}  // namespace strake
