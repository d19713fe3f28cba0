#pragma once

#include <filesystem>
#include <string_view>

namespace strake::meshfile {

/// A file's bytes, mapped into memory for reading.
class MappedFile {
 public:
  /// \throw InputError naming the path where it is no readable regular file
  explicit MappedFile(const std::filesystem::path& path);
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;
  ~MappedFile();

  [[nodiscard]] std::string_view bytes() const { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace strake::meshfile
