#include "common/artifact/atomic_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// Files that are neither committed nor removed; what is done to any of them is done under the
/// lock.
struct Pending {
  std::mutex lock;
  std::set<fs::path> files;
};

Pending& pending_files() {
  static Pending pending;
  return pending;
}

[[noreturn]] void fail(const char* action, const fs::path& path, int error) {
  throw InputError(fmt::format("cannot {} '{}': {}", action, path.string(), std::strerror(error)));
}

fs::path folder_of(const fs::path& target) {
  return target.has_parent_path() ? target.parent_path() : fs::path(".");
}

fs::path resolve_target(const fs::path& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError(
        fmt::format("cannot write '{}': it exists and is not a regular file; give a file name",
                    target.string()));
  }
  // Step by step, as what the last link names need not exist.
  constexpr int kMostLinks = 40;  // as the kernel
  fs::path file = target;
  for (int n = 0; fs::is_symlink(fs::symlink_status(file, ignored)); ++n) {
    if (n == kMostLinks) fail("write", target, ELOOP);
    file = folder_of(file) / fs::read_symlink(file, ignored);
  }
  return file;
}

bool same_bytes(const fs::path& a, const fs::path& b) {
  std::error_code error_a;
  std::error_code error_b;
  const auto size_a = fs::file_size(a, error_a);
  const auto size_b = fs::file_size(b, error_b);
  if (error_a || error_b || size_a != size_b) return false;
  std::ifstream stream_a(a, std::ios::binary);
  std::ifstream stream_b(b, std::ios::binary);
  constexpr std::streamsize kBlock = 1 << 20;
  std::vector<char> block_a(kBlock);
  std::vector<char> block_b(kBlock);
  for (auto left = static_cast<std::streamsize>(size_a); left > 0;) {
    const std::streamsize count = std::min(left, kBlock);
    if (!stream_a.read(block_a.data(), count) || !stream_b.read(block_b.data(), count)) {
      return false;
    }
    if (std::memcmp(block_a.data(), block_b.data(), static_cast<std::size_t>(count)) != 0) {
      return false;
    }
    left -= count;
  }
  return true;
}

/// Flushes a file or folder to the disk. File systems that cannot flush folders say EINVAL.
void flush_to_disk(const fs::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) fail("open", path, errno);
  int error = 0;
  if (::fsync(descriptor) != 0 && errno != EINVAL && errno != ENOTSUP) error = errno;
  if (::close(descriptor) != 0 && error == 0) error = errno;
  if (error != 0) fail("flush", path, error);
}

}  // namespace

bool write_all(int descriptor, const void* data, std::size_t size) {
  const char* at = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t written = ::write(descriptor, at, size);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    at += written;
    size -= static_cast<std::size_t>(written);
  }
  return true;
}

AtomicFile::AtomicFile(const fs::path& target) : target_(resolve_target(target)) {
  static std::atomic<unsigned> counter{0};
  const std::string name = target_.filename().string();
  const std::lock_guard guard(pending_files().lock);
  // A name left behind by a killed process of the same number is skipped.
  for (int attempt = 0; attempt < 1000; ++attempt) {
    temporary_ = folder_of(target_) / fmt::format(".{}.{}-{}.tmp", name, ::getpid(), counter++);
    const int descriptor =
        ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (descriptor >= 0) {
      ::close(descriptor);
      pending_ = true;
      pending_files().files.insert(temporary_);
      return;
    }
    if (errno != EEXIST) fail("write", target_, errno);
  }
  fail("write", target_, EEXIST);
}

AtomicFile::~AtomicFile() {
  if (!pending_) return;
  const std::lock_guard guard(pending_files().lock);
  std::error_code ignored;
  fs::remove(temporary_, ignored);
  pending_files().files.erase(temporary_);
}

void AtomicFile::abandon_all() {
  pending_files().lock.lock();
  std::error_code ignored;
  for (const fs::path& file : pending_files().files) fs::remove(file, ignored);
}

bool AtomicFile::commit(Flush flush) {
  const bool is_new = !same_bytes(temporary_, target_);
  if (is_new && flush == Flush::yes) flush_to_disk(temporary_, O_RDWR);
  {
    const std::lock_guard guard(pending_files().lock);
    std::error_code ignored;
    if (!is_new) fs::remove(temporary_, ignored);
    if (is_new && ::rename(temporary_.c_str(), target_.c_str()) != 0) {
      fail("replace", target_, errno);
    }
    pending_files().files.erase(temporary_);
    pending_ = false;
  }
  if (!is_new) return false;
  if (flush == Flush::yes) flush_to_disk(folder_of(target_), O_RDONLY | O_DIRECTORY);
  return true;
}

}  // namespace strake
