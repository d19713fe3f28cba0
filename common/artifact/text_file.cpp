#include "common/artifact/text_file.h"

#include <array>
#include <fstream>

#include "common/core/error.h"

namespace strake {

void write_text(const std::filesystem::path& path, const std::string& text, Flush flush) {
  AtomicFile file(path);
  std::ofstream stream(file.temporary(), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw InputError(path.string() + ": cannot be written; is the disk full?");
  file.commit(flush);
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
