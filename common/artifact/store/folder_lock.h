#pragma once

#include <filesystem>

namespace strake {

/// The exclusive right to a folder, among processes and machines that share it: to write an entry
/// of a store, or to go on with a run that is recorded there.
///
/// The kernel gives it up when its owner ends, however that happens. A file system without locks
/// is no error: two makers of one entry write the same bytes, only the work is done twice.
class FolderLock {
 public:
  /// Takes the lock if it is free. Makes the folder where it is missing.
  /// \throw InputError where the folder cannot be written
  explicit FolderLock(const std::filesystem::path& folder);
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;
  ~FolderLock();

  /// False while somebody else has it; try again with a new object.
  [[nodiscard]] bool is_held() const { return held_; }
  /// False where others may have it at the same time, as the file system has no locks: what they
  /// are writing must stay.
  [[nodiscard]] bool is_exclusive() const { return held_ && exclusive_; }

 private:
  int descriptor_ = -1;
  bool held_ = false;
  bool exclusive_ = false;
};

}  // namespace strake
