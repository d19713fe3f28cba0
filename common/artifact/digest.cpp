#include "common/artifact/digest.h"

#include <xxhash.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "common/core/error.h"

namespace strake {
namespace {

std::string to_text(const XXH128_hash_t& hash) {
  XXH128_canonical_t canonical;
  XXH128_canonicalFromHash(&canonical, hash);
  std::string text;
  for (const unsigned char byte : canonical.digest) {
    char digits[3];
    std::snprintf(digits, sizeof digits, "%02x", byte);
    text += digits;
  }
  return text;
}

}  // namespace

Digest::Digest() : state_(XXH3_createState()) { XXH3_128bits_reset(state_); }

Digest::~Digest() { XXH3_freeState(state_); }

void Digest::add(const void* data, std::size_t bytes) { XXH3_128bits_update(state_, data, bytes); }

std::string Digest::text() const { return to_text(XXH3_128bits_digest(state_)); }

std::string digest_text(std::string_view text) {
  return to_text(XXH3_128bits(text.data(), text.size()));
}

std::string digest_file(const std::filesystem::path& path) {
  std::error_code ignored;
  const auto status = std::filesystem::status(path, ignored);
  if (std::filesystem::is_directory(status)) {
    throw InputError(path.string() + ": is a folder; give a file");
  }
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
    throw InputError(path.string() + ": is not a regular file; give one");
  }
  std::ifstream stream(path, std::ios::binary);
  Digest digest;
  std::vector<char> block(1 << 20);
  while (stream) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    digest.add(block.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (!stream.eof()) throw InputError(path.string() + ": cannot be read; check name and rights");
  return digest.text();
}

}  // namespace strake
