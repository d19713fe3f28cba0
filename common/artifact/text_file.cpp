#include "common/artifact/text_file.h"

#include <array>
#include <fstream>

#include "common/core/error.h"

namespace strake {

void write_text(const std::filesystem::path& path, const std::string& text, Flush flush) {
  AtomicFile file(path);
  write_text(file, text);
  file.commit(flush);
}

void write_text(AtomicFile& file, const std::string& text) {
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw InputError(file.target().string() + ": cannot be written; is the disk full?");
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  const auto fail = [&] {
    throw InputError(path.string() + ": cannot be read; check name and permissions");
  };
  if (!stream) fail();
  std::string text;
  for (std::array<char, 1 << 16> part{}; stream;) {
    stream.read(part.data(), part.size());
    text.append(part.data(), static_cast<std::size_t>(stream.gcount()));
  }
  if (stream.bad()) fail();
  return text;
}

}  // namespace strake
