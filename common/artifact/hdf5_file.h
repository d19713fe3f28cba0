#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <type_traits>
#include <vector>

#include "common/core/error.h"
#include "common/core/types.h"

/// Typed tables in HDF5 files. Only its source, and that of the driver, include hdf5.h.
namespace strake::hdf5 {

enum class Scalar { u8, i32, i64, f64 };

/// Shape of a dataset: `columns` is 1 for one-dimensional data.
struct Shape {
  std::int64_t rows = 0;
  std::int64_t columns = 1;
  bool is_table = false;  ///< two-dimensional
};

struct DatasetInfo {
  std::string name;  ///< within its group
  Shape shape;
  Scalar scalar = Scalar::f64;
};

/// How a row type of C++ is stored: its scalar and the number of them.
template <class Row>
struct RowTraits {
  static_assert(sizeof(Row) == 1 && (std::is_enum_v<Row> || std::is_same_v<Row, std::uint8_t>));
  static constexpr Scalar kScalar = Scalar::u8;
  static constexpr std::int64_t kColumns = 1;
};
template <>
struct RowTraits<std::int32_t> {
  static constexpr Scalar kScalar = Scalar::i32;
  static constexpr std::int64_t kColumns = 1;
};
template <>
struct RowTraits<std::int64_t> {
  static constexpr Scalar kScalar = Scalar::i64;
  static constexpr std::int64_t kColumns = 1;
};
template <>
struct RowTraits<double> {
  static constexpr Scalar kScalar = Scalar::f64;
  static constexpr std::int64_t kColumns = 1;
};
template <>
struct RowTraits<Vec3> {
  static_assert(sizeof(Vec3) == 3 * sizeof(double));
  static constexpr Scalar kScalar = Scalar::f64;
  static constexpr std::int64_t kColumns = 3;
};
template <class T, std::size_t N>
struct RowTraits<std::array<T, N>> {
  static constexpr Scalar kScalar = RowTraits<T>::kScalar;
  static constexpr std::int64_t kColumns = N;
};

/// Whether rows of several scalars become a two-dimensional dataset or follow each other in one
/// row.
enum class Layout { table, flat };

/// An open HDF5 file; closes what it opened.
class File {
 public:
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  ~File();

 protected:
  explicit File(std::filesystem::path shown) noexcept : shown_(std::move(shown)) {}
  /// Throws an InputError that names the file, the object and HDF5's own reason.
  [[noreturn]] void fail(const std::string& object, const std::string& what) const;

  std::filesystem::path shown_;  ///< as the user knows it
  std::int64_t id_ = -1;         ///< an hid_t
};

/// Makes a new file: equal calls give equal bytes, each chunk carries a checksum.
class Writer : public File {
 public:
  /// \param path   file to create or overwrite, usually a temporary one
  /// \param shown  its name in messages
  Writer(const std::filesystem::path& path, std::filesystem::path shown);
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer();

  void group(const std::string& name);
  /// Gives the dataset `existing` a second name, without a copy.
  void link(const std::string& existing, const std::string& name);
  /// Attributes of the group `object`, "/" for the root.
  void attribute(const std::string& object, const std::string& name, const std::string& ascii);
  void attribute(const std::string& object, const std::string& name,
                 const std::vector<std::int64_t>& values);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);

  template <class Row>
  void dataset(const std::string& name, const std::vector<Row>& rows,
               Layout layout = Layout::table) {
    constexpr std::int64_t kColumns = RowTraits<Row>::kColumns;
    const auto count = static_cast<std::int64_t>(rows.size());
    const bool is_table = kColumns > 1 && layout == Layout::table;
    write(name, rows.data(), RowTraits<Row>::kScalar,
          is_table ? Shape{count, kColumns, true} : Shape{count * kColumns, 1, false});
  }

  /// Writes and closes the file. \throw InputError, e.g. disk full
  void finish();

 private:
  void write(const std::string& name, const void* data, Scalar scalar, const Shape& shape);

  /// \throw InputError where something could not be written
  void require_written() const;

  int error_ = 0;  ///< errno of the first write that failed
};

/// Reads a file and trusts nothing in it: links to other files, filters but checksums, plugins and
/// sizes that the file cannot hold are refused.
class Reader : public File {
 public:
  /// \throw InputError where the file is missing, no HDF5 file, or damaged
  explicit Reader(const std::filesystem::path& path);

  [[nodiscard]] bool has(const std::string& name) const;
  /// Attributes of the root.
  [[nodiscard]] bool has_attribute(const std::string& name) const;
  [[nodiscard]] std::string text_attribute(const std::string& name) const;
  [[nodiscard]] std::int64_t integer_attribute(const std::string& name) const;
  /// The datasets of a group, by name.
  [[nodiscard]] std::vector<DatasetInfo> list(const std::string& group) const;

  /// The number of rows. \throw InputError where type or shape are not those of `Row`
  template <class Row>
  [[nodiscard]] std::int64_t row_count(const std::string& name,
                                       Layout layout = Layout::table) const {
    constexpr std::int64_t kColumns = RowTraits<Row>::kColumns;
    const bool is_table = kColumns > 1 && layout == Layout::table;
    const Shape shape = checked_shape(name, RowTraits<Row>::kScalar, is_table);
    if (is_table ? shape.columns != kColumns : shape.rows % kColumns != 0) {
      refuse(name, "has rows of a wrong length");
    }
    return is_table ? shape.rows : shape.rows / kColumns;
  }
  /// Rows first ... first + count - 1.
  /// \pre there are as many, and `row_count` was satisfied with type and shape
  template <class Row>
  [[nodiscard]] std::vector<Row> rows(const std::string& name, std::int64_t first,
                                      std::int64_t count, Layout layout = Layout::table) const {
    constexpr std::int64_t kColumns = RowTraits<Row>::kColumns;
    const bool is_table = kColumns > 1 && layout == Layout::table;
    std::vector<Row> rows(static_cast<std::size_t>(count));
    const Shape shape = is_table ? Shape{count, kColumns, true} : Shape{count * kColumns, 1, false};
    read(name, rows.data(), RowTraits<Row>::kScalar, is_table ? first : first * kColumns, shape);
    return rows;
  }
  /// The whole dataset. \throw InputError where type or shape are not those of `Row`
  template <class Row>
  [[nodiscard]] std::vector<Row> dataset(const std::string& name,
                                         Layout layout = Layout::table) const {
    return rows<Row>(name, 0, row_count<Row>(name, layout), layout);
  }

  /// Reads every dataset of a group for nothing but its checksums. \throw InputError
  void read_all(const std::string& group) const;

  /// Throws an InputError that names this file and the dataset.
  [[noreturn]] void refuse(const std::string& name, const std::string& what) const;

 private:
  /// Names of all that a group holds, in alphabetical order.
  [[nodiscard]] std::vector<std::string> link_names(std::int64_t opened,
                                                    const std::string& group) const;
  [[nodiscard]] Shape checked_shape(const std::string& name, Scalar scalar, bool is_table) const;
  /// Reads a block of the given shape that begins at row `first` of the dataset.
  void read(const std::string& name, void* data, Scalar scalar, std::int64_t first,
            const Shape& block) const;

  std::uintmax_t bytes_ = 0;  ///< of the file
};

}  // namespace strake::hdf5
