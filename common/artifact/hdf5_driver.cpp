#include "common/artifact/hdf5_driver.h"

#include <fcntl.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include "common/artifact/atomic_file.h"

#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

namespace strake::hdf5 {
namespace {

/// What HDF5 carries from the property list to the file.
struct Settings {
  int* error;
};

/// An open file, as HDF5 knows it.
struct Output {
  H5FD_t base;  ///< must be first: HDF5 fills it in and hands out pointers to it
  int descriptor;
  int* error;
  haddr_t end_of_allocation;
  haddr_t end_of_file;

  void note(bool worked) {
    if (!worked && *error == 0) *error = errno;
  }
};

Output& output_of(H5FD_t* file) { return *reinterpret_cast<Output*>(file); }
const Output& output_of(const H5FD_t* file) { return *reinterpret_cast<const Output*>(file); }

H5FD_t* open_output(const char* path, unsigned /*flags*/, hid_t access, haddr_t /*most*/) {
  const auto* settings = static_cast<const Settings*>(H5Pget_driver_info(access));
  if (settings == nullptr) return nullptr;
  const int descriptor = ::open(path, O_RDWR | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) {
    *settings->error = errno;
    return nullptr;
  }
  auto* output = new Output{};
  output->descriptor = descriptor;
  output->error = settings->error;
  return &output->base;
}

herr_t close_output(H5FD_t* file) {
  Output& output = output_of(file);
  output.note(::close(output.descriptor) == 0);
  delete &output;
  return 0;
}

herr_t write_output(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                    std::size_t size, const void* bytes) {
  Output& output = output_of(file);
  output.end_of_file = std::max(output.end_of_file, address + size);
  if (*output.error != 0) return 0;
  const bool found = ::lseek(output.descriptor, static_cast<off_t>(address), SEEK_SET) >= 0;
  output.note(found && write_all(output.descriptor, bytes, size));
  return 0;
}

/// Reads back what was written; zeros where nothing was.
herr_t read_output(H5FD_t* file, H5FD_mem_t /*type*/, hid_t /*transfer*/, haddr_t address,
                   std::size_t size, void* bytes) {
  const Output& output = output_of(file);
  auto* to = static_cast<char*>(bytes);
  std::memset(to, 0, size);
  while (size > 0) {
    const ssize_t count = ::pread(output.descriptor, to, size, static_cast<off_t>(address));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) break;
    to += count;
    address += static_cast<haddr_t>(count);
    size -= static_cast<std::size_t>(count);
  }
  return 0;
}

herr_t truncate_output(H5FD_t* file, hid_t /*transfer*/, hbool_t /*closing*/) {
  Output& output = output_of(file);
  output.end_of_file = output.end_of_allocation;
  if (*output.error != 0) return 0;
  output.note(::ftruncate(output.descriptor, static_cast<off_t>(output.end_of_allocation)) == 0);
  return 0;
}

/// Metadata is gathered in memory and written in large pieces, as by HDF5's own drivers.
herr_t query_features(const H5FD_t* /*file*/, unsigned long* features) {
  *features = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
              H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

H5FD_class_t driver_class() {
  H5FD_class_t driver = {};
#if H5_VERSION_GE(1, 13, 0)
  driver.version = H5FD_CLASS_VERSION;
  driver.value = static_cast<H5FD_class_value_t>(256);  // the first of those for private use
#endif
  driver.name = "strake_output";
  driver.maxaddr = HADDR_MAX;
  driver.fc_degree = H5F_CLOSE_WEAK;
  driver.fapl_size = sizeof(Settings);
  driver.open = open_output;
  driver.close = close_output;
  driver.query = query_features;
  driver.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return output_of(file).end_of_allocation; };
  driver.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t address) -> herr_t {
    output_of(file).end_of_allocation = address;
    return 0;
  };
  driver.get_eof = [](const H5FD_t* file, H5FD_mem_t) { return output_of(file).end_of_file; };
  driver.read = read_output;
  driver.write = write_output;
  driver.truncate = truncate_output;
  constexpr H5FD_mem_t kLists[] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kLists), std::end(kLists), std::begin(driver.fl_map));
  return driver;
}

}  // namespace

bool set_output_driver(std::int64_t access, int* error) {
  static const H5FD_class_t driver = driver_class();
  static const hid_t id = H5FDregister(&driver);
  const Settings settings = {error};
  return id >= 0 && H5Pset_driver(access, id, &settings) >= 0;
}

}  // namespace strake::hdf5
