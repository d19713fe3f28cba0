#include "common/artifact/hdf5_file.h"

#include <hdf5.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/artifact/hdf5_driver.h"

namespace strake::hdf5 {
namespace {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

constexpr std::int64_t kChunkBytes = 1 << 20;
constexpr std::int64_t kMaxRows = std::int64_t{1} << 40;

/// Closes an HDF5 object when it goes out of scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*closer)(hid_t)) : id_(id), close_(closer) {}
  Handle(Handle&& other) noexcept
      : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  [[nodiscard]] hid_t id() const { return id_; }
  [[nodiscard]] bool valid() const { return id_ >= 0; }
  /// Closes now and says whether that worked.
  [[nodiscard]] bool close() { return close_(std::exchange(id_, H5I_INVALID_HID)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// Keeps HDF5 from printing its error stack, as what went wrong goes into the exception instead,
/// and from loading code that a file names.
void set_up() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5PLset_loading_state(0);
}

/// The innermost message of HDF5's error stack, which names the cause.
std::string innermost_reason() {
  std::string text;
  const auto keep_first = [](unsigned depth, const H5E_error2_t* error, void* data) -> herr_t {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(data) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_first, &text);
  return text;
}

hid_t file_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::u8:
      return H5T_STD_U8LE;
    case Scalar::i32:
      return H5T_STD_I32LE;
    case Scalar::i64:
      return H5T_STD_I64LE;
    case Scalar::f64:
      return H5T_IEEE_F64LE;
  }
  return H5I_INVALID_HID;
}

hid_t memory_type(Scalar scalar) {
  switch (scalar) {
    case Scalar::u8:
      return H5T_NATIVE_UINT8;
    case Scalar::i32:
      return H5T_NATIVE_INT32;
    case Scalar::i64:
      return H5T_NATIVE_INT64;
    case Scalar::f64:
      return H5T_NATIVE_DOUBLE;
  }
  return H5I_INVALID_HID;
}

std::int64_t size_of(Scalar scalar) {
  switch (scalar) {
    case Scalar::u8:
      return 1;
    case Scalar::i32:
      return 4;
    case Scalar::i64:
    case Scalar::f64:
      return 8;
  }
  return 0;
}

/// Dimensions of a dataset; rank -1 where it has more than two or cannot be asked.
std::pair<int, std::array<hsize_t, 2>> dimensions(hid_t dataset) {
  std::array<hsize_t, 2> sizes = {0, 1};
  const Handle space(H5Dget_space(dataset), H5Sclose);
  if (!space.valid()) return {-1, sizes};
  const int rank = H5Sget_simple_extent_ndims(space.id());
  if (rank < 1 || rank > 2) return {-1, sizes};
  if (H5Sget_simple_extent_dims(space.id(), sizes.data(), nullptr) < 0) return {-1, sizes};
  return {rank, sizes};
}

Handle text_type(std::size_t length) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type.id(), std::max<std::size_t>(length, 1));
  H5Tset_strpad(type.id(), H5T_STR_NULLPAD);
  return type;
}

/// Whether the object lies in the file itself: no link on the way leads to a name or another file.
bool is_inside(std::int64_t place, const std::string& name) {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    H5L_info_t link;
    if (H5Lget_info(place, name.substr(0, end).c_str(), &link, H5P_DEFAULT) < 0) return false;
    if (link.type != H5L_TYPE_HARD) return false;
  }
  return true;
}

Handle open_dataset(std::int64_t place, const std::string& name) {
  const bool inside = is_inside(place, name);
  return {inside ? H5Dopen2(place, name.c_str(), H5P_DEFAULT) : H5I_INVALID_HID, H5Dclose};
}

/// What is wrong where the dataset's numbers do not lie in the file as they are, at most with
/// checksums; or "".
std::string fault_of_storage(hid_t dataset) {
  const Handle creation(H5Dget_create_plist(dataset), H5Pclose);
  if (!creation.valid()) return "does not say how it is stored";
  const H5D_layout_t layout = H5Pget_layout(creation.id());
  if (layout != H5D_COMPACT && layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED) {
    return "is put together from other files, which are not read";
  }
  if (H5Pget_external_count(creation.id()) != 0) return "is in another file, which is not read";
  const int filters = H5Pget_nfilters(creation.id());
  if (filters < 0) return "does not say how it is stored";
  bool is_filtered = false;
  for (int i = 0; i < filters; ++i) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter = H5Pget_filter2(creation.id(), static_cast<unsigned>(i), &flags,
                                               &values, nullptr, 0, nullptr, nullptr);
    if (filter == H5Z_FILTER_DEFLATE) {
      return "is compressed (gzip), which is not read; write it without compression";
    }
    is_filtered = is_filtered || filter != H5Z_FILTER_FLETCHER32;
  }
  return is_filtered ? "is filtered, which is not read; write it without filters" : "";
}

}  // namespace

File::~File() {
  if (id_ >= 0) H5Fclose(id_);
}

void File::fail(const std::string& object, const std::string& what) const {
  std::string message = shown_.string() + ": ";
  if (!object.empty()) message += "'" + object + "' ";
  message += what;
  const std::string reason = innermost_reason();
  throw InputError(reason.empty() ? message : message + " (HDF5: " + reason + ")");
}

Writer::Writer(const std::filesystem::path& path, std::filesystem::path shown)
    : File(std::move(shown)) {
  set_up();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  // Version 1.10 structures carry checksums of their own; times would make equal files differ.
  H5Pset_libver_bounds(access.id(), H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_obj_track_times(creation.id(), false);
  if (!set_output_driver(access.id(), &error_)) fail("", "cannot be created");
  id_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.id(), access.id());
  if (id_ >= 0) return;
  require_written();
  fail("", "cannot be created");
}

void Writer::group(const std::string& name) {
  const Handle creation(H5Pcreate(H5P_GROUP_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  Handle group(H5Gcreate2(id_, name.c_str(), H5P_DEFAULT, creation.id(), H5P_DEFAULT), H5Gclose);
  if (!group.valid() || !group.close()) fail(name, "cannot be written");
}

void Writer::link(const std::string& existing, const std::string& name) {
  if (H5Lcreate_hard(id_, existing.c_str(), id_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT) < 0) {
    fail(name, "cannot be written");
  }
}

void Writer::attribute(const std::string& object, const std::string& name,
                       const std::string& ascii) {
  const Handle type = text_type(ascii.size());
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  Handle attribute(H5Acreate_by_name(id_, object.c_str(), name.c_str(), type.id(), space.id(),
                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.id(), type.id(), ascii.c_str()) < 0 ||
      !attribute.close()) {
    fail(name, "cannot be written");
  }
}

void Writer::attribute(const std::string& object, const std::string& name,
                       const std::vector<std::int64_t>& values) {
  const hsize_t count = values.size();
  const Handle space(
      values.size() == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  Handle attribute(H5Acreate_by_name(id_, object.c_str(), name.c_str(), H5T_STD_I64LE, space.id(),
                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                   H5Aclose);
  if (!attribute.valid() || H5Awrite(attribute.id(), H5T_NATIVE_INT64, values.data()) < 0 ||
      !attribute.close()) {
    fail(name, "cannot be written");
  }
}

void Writer::attribute(const std::string& object, const std::string& name, std::int64_t value) {
  attribute(object, name, std::vector<std::int64_t>{value});
}

void Writer::write(const std::string& name, const void* data, Scalar scalar, const Shape& shape) {
  const std::array<hsize_t, 2> sizes = {static_cast<hsize_t>(shape.rows),
                                        static_cast<hsize_t>(shape.columns)};
  const int rank = shape.is_table ? 2 : 1;
  const Handle space(H5Screate_simple(rank, sizes.data(), nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation.id(), false);
  if (shape.rows > 0) {  // an empty dataset can neither be chunked nor damaged
    const std::int64_t rows_per_chunk = kChunkBytes / (shape.columns * size_of(scalar));
    const std::array<hsize_t, 2> chunk = {
        static_cast<hsize_t>(std::clamp<std::int64_t>(rows_per_chunk, 1, shape.rows)), sizes[1]};
    H5Pset_chunk(creation.id(), rank, chunk.data());
    H5Pset_fletcher32(creation.id());
  }
  Handle dataset(H5Dcreate2(id_, name.c_str(), file_type(scalar), space.id(), H5P_DEFAULT,
                            creation.id(), H5P_DEFAULT),
                 H5Dclose);
  if (!dataset.valid()) fail(name, "cannot be written");
  if (shape.rows > 0 &&
      H5Dwrite(dataset.id(), memory_type(scalar), H5S_ALL, H5S_ALL, H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be written");
  }
  if (!dataset.close()) fail(name, "cannot be written");
  require_written();
}

void Writer::finish() {
  if (H5Fclose(std::exchange(id_, -1)) < 0) fail("", "cannot be written");
  require_written();
}

void Writer::require_written() const {
  if (error_ == 0) return;
  throw InputError("cannot write '" + shown_.string() + "': " + std::strerror(error_));
}

Writer::~Writer() {
  if (id_ >= 0) H5Fclose(std::exchange(id_, -1));  // before `error_` goes
}

Reader::Reader(const std::filesystem::path& path) : File(path) {
  set_up();
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(path.string() + ": no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw InputError(path.string() + ": is not a regular file");
  }
  bytes_ = std::filesystem::file_size(path, error);
  id_ = H5Fopen(shown_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (id_ < 0 && innermost_reason().starts_with("truncated file")) {
    throw InputError(shown_.string() + ": is cut off after " + std::to_string(bytes_) +
                     " bytes, as where copying it was interrupted or the disk was full; copy it "
                     "again, or make it again");
  }
  if (id_ < 0)
    fail("", "is not an artifact of strake, or is damaged; strake-import makes one of a mesh file");
}

bool Reader::has(const std::string& name) const { return is_inside(id_, name); }

bool Reader::has_attribute(const std::string& name) const {
  return H5Aexists(id_, name.c_str()) > 0;
}

std::string Reader::text_attribute(const std::string& name) const {
  const Handle attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail(name, "is missing: not an artifact of strake, or damaged");
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  if (!type.valid() || H5Tget_class(type.id()) != H5T_STRING ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    refuse(name, "is not a text");
  }
  // They lie in a heap of their own, and reading a damaged one ended the process in trials.
  if (H5Tis_variable_str(type.id()) != 0) {
    refuse(name,
           "is a text of variable length, as h5py makes of str; write it with a length of its "
           "own, as h5py makes of numpy.bytes_");
  }
  if (H5Tget_size(type.id()) > bytes_) refuse(name, "claims more than the file holds");
  std::string text(H5Tget_size(type.id()), '\0');
  const Handle memory = text_type(text.size());
  H5Tset_cset(memory.id(), H5Tget_cset(type.id()));
  if (H5Aread(attribute.id(), memory.id(), text.data()) < 0) fail(name, "cannot be read");
  text.erase(std::find(text.begin(), text.end(), '\0'), text.end());
  return text;
}

std::int64_t Reader::integer_attribute(const std::string& name) const {
  const Handle attribute(H5Aopen(id_, name.c_str(), H5P_DEFAULT), H5Aclose);
  if (!attribute.valid()) fail(name, "is missing: not an artifact of strake, or damaged");
  const Handle type(H5Aget_type(attribute.id()), H5Tclose);
  const Handle space(H5Aget_space(attribute.id()), H5Sclose);
  std::int64_t value = 0;
  if (!type.valid() || H5Tget_class(type.id()) != H5T_INTEGER ||
      H5Sget_simple_extent_npoints(space.id()) != 1) {
    refuse(name, "is not an integer");
  }
  if (H5Aread(attribute.id(), H5T_NATIVE_INT64, &value) < 0) fail(name, "cannot be read");
  return value;
}

std::vector<std::string> Reader::link_names(std::int64_t opened, const std::string& group) const {
  // In the order of the file: to sort links itself, HDF5 1.10 makes a table of them, and frees what
  // it never filled in where one of them is damaged.
  const auto keep = [](hid_t, const char* name, const H5L_info_t*, void* names) -> herr_t {
    static_cast<std::vector<std::string>*>(names)->emplace_back(name);
    return 0;
  };
  std::vector<std::string> names;
  if (H5Literate(opened, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, keep, &names) < 0) {
    fail(group, "cannot be read");
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::vector<DatasetInfo> Reader::list(const std::string& group) const {
  if (!is_inside(id_, group)) refuse(group, "is missing or elsewhere");
  const Handle opened(H5Gopen2(id_, group.c_str(), H5P_DEFAULT), H5Gclose);
  if (!opened.valid()) fail(group, "cannot be read");
  std::vector<DatasetInfo> datasets;
  for (const std::string& name : link_names(opened.id(), group)) {
    const Handle dataset = open_dataset(opened.id(), name);
    if (!dataset.valid()) continue;
    const auto [rank, sizes] = dimensions(dataset.id());
    const Handle type(H5Dget_type(dataset.id()), H5Tclose);
    for (const Scalar scalar : {Scalar::u8, Scalar::i32, Scalar::i64, Scalar::f64}) {
      if (rank < 0 || H5Tequal(type.id(), file_type(scalar)) <= 0) continue;
      datasets.push_back(
          {name,
           {static_cast<std::int64_t>(sizes[0]), static_cast<std::int64_t>(sizes[1]), rank == 2},
           scalar});
    }
  }
  return datasets;
}

Shape Reader::checked_shape(const std::string& name, Scalar scalar, bool is_table) const {
  const Handle dataset = open_dataset(id_, name);
  if (!dataset.valid()) fail(name, "is missing, damaged or in another file");
  const Handle type(H5Dget_type(dataset.id()), H5Tclose);
  if (H5Tequal(type.id(), file_type(scalar)) <= 0) refuse(name, "has a wrong number type");
  const auto [rank, sizes] = dimensions(dataset.id());
  if (rank != (is_table ? 2 : 1)) refuse(name, "has a wrong number of dimensions");
  const Shape shape = {static_cast<std::int64_t>(sizes[0]), static_cast<std::int64_t>(sizes[1]),
                       rank == 2};
  if (shape.rows < 0 || shape.rows > kMaxRows || shape.columns < 1 || shape.columns > 64) {
    refuse(name, "claims an impossible size");
  }
  const std::string fault = fault_of_storage(dataset.id());
  if (!fault.empty()) refuse(name, fault);
  // Chunks that were never written read as zeros without any error, so their absence is one.
  const auto wanted = static_cast<hsize_t>(shape.rows * shape.columns * size_of(scalar));
  if (wanted > bytes_) refuse(name, "claims more than the file holds");
  if (H5Dget_storage_size(dataset.id()) < wanted) refuse(name, "is incomplete");
  return shape;
}

void Reader::read(const std::string& name, void* data, Scalar scalar, std::int64_t first,
                  const Shape& block) const {
  if (block.rows == 0) return;
  const std::array<hsize_t, 2> start = {static_cast<hsize_t>(first), 0};
  const std::array<hsize_t, 2> size = {static_cast<hsize_t>(block.rows),
                                       static_cast<hsize_t>(block.columns)};
  const Handle dataset = open_dataset(id_, name);
  const Handle there(H5Dget_space(dataset.id()), H5Sclose);
  const Handle here(H5Screate_simple(block.is_table ? 2 : 1, size.data(), nullptr), H5Sclose);
  if (H5Sselect_hyperslab(there.id(), H5S_SELECT_SET, start.data(), nullptr, size.data(), nullptr) <
          0 ||
      H5Dread(dataset.id(), memory_type(scalar), here.id(), there.id(), H5P_DEFAULT, data) < 0) {
    fail(name, "cannot be read; the file is damaged, make it again");
  }
}

void Reader::read_all(const std::string& group) const {
  for (const DatasetInfo& dataset : list(group)) {
    const std::string name = group + "/" + dataset.name;
    const Shape shape = checked_shape(name, dataset.scalar, dataset.shape.is_table);
    std::vector<char> data(static_cast<std::size_t>(shape.rows * shape.columns) *
                           static_cast<std::size_t>(size_of(dataset.scalar)));
    read(name, data.data(), dataset.scalar, 0, shape);
  }
}

void Reader::refuse(const std::string& name, const std::string& what) const {
  throw InputError(shown_.string() + ": '" + name + "' " + what);
}

}  // namespace strake::hdf5
