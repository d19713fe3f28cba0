#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace strake {

/// Digests of files outside the store, remembered as long as the files' stamps stay the same, so
/// that a model of a gigabyte is read once and not at every look.
class KnownDigests {
 public:
  /// \param folder  where to remember; may be missing or not writable, then nothing is remembered
  explicit KnownDigests(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// `digest_file` of a file. \throw InputError where it cannot be read
  std::string digest(const std::filesystem::path& file);
  /// The same; nothing where there is no such file.
  std::optional<std::string> find(const std::filesystem::path& file);

 private:
  std::filesystem::path folder_;
};

}  // namespace strake
