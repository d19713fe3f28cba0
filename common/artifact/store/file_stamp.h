#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace strake {

/// What the file system says about a file without reading it. Equal stamps mean equal bytes, unless
/// somebody works around it; a change of the bytes changes the stamp.
struct FileStamp {
  std::int64_t size = 0;         ///< bytes
  std::int64_t modified_ns = 0;  ///< since 1970; people and programs may set it back ...
  std::int64_t changed_ns = 0;   ///< ... but not this one
  friend bool operator==(const FileStamp&, const FileStamp&) = default;
};

/// Nothing where there is no such regular file.
std::optional<FileStamp> stamp_of(const std::filesystem::path& path);

}  // namespace strake
