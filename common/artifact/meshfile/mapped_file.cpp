#include "common/artifact/meshfile/mapped_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "common/core/error.h"

namespace strake::meshfile {

MappedFile::MappedFile(const std::filesystem::path& path) {
  // Without waiting for whoever writes into a pipe, which is refused anyway.
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  struct stat status = {};
  int error = 0;
  if (descriptor < 0 || ::fstat(descriptor, &status) != 0) {
    error = errno;
  } else if (!S_ISREG(status.st_mode)) {
    ::close(descriptor);
    throw InputError(fmt::format("'{}' is not a regular file; give one", path.string()));
  } else if (status.st_size > 0) {
    size_ = static_cast<std::size_t>(status.st_size);
    void* data = ::mmap(nullptr, size_, PROT_READ, MAP_PRIVATE | MAP_POPULATE, descriptor, 0);
    if (data == MAP_FAILED) {
      error = errno;
    } else {
      data_ = static_cast<const char*>(data);
    }
  }
  if (descriptor >= 0) ::close(descriptor);
  if (error != 0) {
    throw InputError(fmt::format("cannot read '{}': {}", path.string(), std::strerror(error)));
  }
}

MappedFile::~MappedFile() {
  if (data_ != nullptr) ::munmap(const_cast<char*>(data_), size_);
}

}  // namespace strake::meshfile
