#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/artifact/store/store.h"

namespace strake {

/// Digests of files outside the store, remembered as long as the files' stamps stay the same, so
/// that a model of a gigabyte is read once and not at every look.
class KnownDigests {
 public:
  /// Remembers in the store; where that is not writable, nothing is remembered.
  explicit KnownDigests(const Store& store)
      : folder_(store.side_folder("digests")), access_(store.access()) {}

  /// `digest_file` of a file. \throw InputError where it cannot be read
  std::string digest(const std::filesystem::path& file);
  /// The same; nothing where there is no such file.
  std::optional<std::string> find(const std::filesystem::path& file);

 private:
  std::filesystem::path folder_;
  Store::Access access_;
};

}  // namespace strake
