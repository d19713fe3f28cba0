#include "common/artifact/text_file.h"

#include <fstream>
#include <sstream>

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
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw InputError(path.string() + ": cannot be read; check name and permissions");
  return text.str();
}

}  // namespace strake
