// Any bytes as a pipeline file: a description, or an error that names the place.

#include <unistd.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/core/error.h"
#include "strake/run/description.h"

namespace {

/// A folder of this process with the file in it and nothing else.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("strake-fuzz-" + std::to_string(::getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  [[nodiscard]] std::filesystem::path file() const { return path_ / "pipeline.yaml"; }

 private:
  std::filesystem::path path_;
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  std::ofstream(folder.file(), std::ios::binary)
      .write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    const strake::Description description = strake::read_description(folder.file());
    if (description.variants.empty()) std::abort();
    (void)strake::parse_setting(description,
                                std::string(reinterpret_cast<const char*>(data), size));
  } catch (const strake::Error& error) {
    if (error.code() == strake::ExitCode::internal) std::abort();
  }
  return 0;
}
