#include "common/artifact/text_file.h"

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

}  // namespace strake
