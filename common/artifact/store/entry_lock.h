#pragma once

#include <filesystem>

namespace strake {

/// The exclusive right to write one entry of a store, among processes and machines that share it.
///
/// The kernel gives it up when its owner ends, however that happens. A file system without locks
/// is no error: two makers of one entry write the same bytes, only the work is done twice.
class EntryLock {
 public:
  /// Takes the lock if it is free. Makes the folder where it is missing.
  /// \throw InputError where the folder cannot be written
  explicit EntryLock(const std::filesystem::path& folder);
  EntryLock(const EntryLock&) = delete;
  EntryLock& operator=(const EntryLock&) = delete;
  ~EntryLock();

  /// False while somebody else has it; try again with a new object.
  [[nodiscard]] bool is_held() const { return held_; }

 private:
  int descriptor_ = -1;
  bool held_ = false;
};

}  // namespace strake
