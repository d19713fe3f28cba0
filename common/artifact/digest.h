#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

struct XXH3_state_s;

namespace strake {

/// XXH3-128 of data that comes piece by piece.
class Digest {
 public:
  Digest();
  Digest(const Digest&) = delete;
  Digest& operator=(const Digest&) = delete;
  ~Digest();

  void add(const void* data, std::size_t bytes);
  /// Of all that was added, as 32 hexadecimal digits.
  [[nodiscard]] std::string text() const;

 private:
  XXH3_state_s* state_;
};

/// XXH3-128 of a file's bytes as 32 hexadecimal digits: names contents, is no proof against malice.
/// \throw InputError where the file cannot be read
std::string digest_file(const std::filesystem::path& path);

/// The same of a text in memory.
std::string digest_text(std::string_view text);

}  // namespace strake
