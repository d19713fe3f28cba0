#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

namespace strake {

/// A share of the memory that the steps of a run may use together.
///
/// Each process locks as many bytes of one file as it needs units of memory, so the kernel gives
/// the share back when the process ends, however that happens. First come, first served: nobody
/// starves behind smaller ones. On a file system without locks nobody waits, and `--jobs` is all
/// that bounds the memory.
class MemoryShare {
 public:
  /// Waits until the share is free.
  /// \param file   the same for all processes that share; is made where it is missing
  /// \param total  bytes for all of them together
  /// \param share  bytes for this one; more than `total` counts as all of it
  /// \param idle   called some times a second while waiting; may throw
  /// \throw InputError where the file cannot be used
  MemoryShare(const std::filesystem::path& file, std::int64_t total, std::int64_t share,
              const std::function<void()>& idle);
  MemoryShare(const MemoryShare&) = delete;
  MemoryShare& operator=(const MemoryShare&) = delete;
  ~MemoryShare();

 private:
  explicit MemoryShare(const std::filesystem::path& file);

  int descriptor_ = -1;
};

}  // namespace strake
