#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/text_scanner.h"

/// The two sources of the values of a PLY file: text and bytes. Each function returns false where
/// the data ends or cannot be followed any further.
namespace strake::meshfile {

static_assert(std::endian::native == std::endian::little, "binary PLY is read as little-endian");

class AsciiValues {
 public:
  explicit AsciiValues(std::string_view text) : scanner_(text) {}

  [[nodiscard]] std::uint64_t remaining() const { return scanner_.remaining(); }
  /// Every value takes a digit and a separator, except for the very last.
  static std::uint64_t smallest_row(const PlyElement& element) {
    return std::max<std::uint64_t>(2 * element.properties.size(), 1);
  }
  bool begin_row() { return scanner_.skip_space(); }
  void end_row() { scanner_.next_line(); }  // extra columns are of no interest

  /// NaN where the text is no number.
  bool real(PlyType /*type*/, double& value) {
    return scanner_.skip_space() && scanner_.number(value);
  }
  /// kNone where the text is no integer. Some programs write 3.0 for 3.
  bool integer(PlyType type, std::int64_t& value) {
    double number = 0;
    if (!real(type, number)) return false;
    constexpr double kLargest = 9e15;
    value = std::abs(number) < kLargest && std::trunc(number) == number
                ? static_cast<std::int64_t>(number)
                : kNone;
    return true;
  }
  bool skip(PlyType type, std::int64_t count) {
    double ignored = 0;
    for (std::int64_t i = 0; i < count; ++i) {
      if (!real(type, ignored)) return false;
    }
    return true;
  }

 private:
  TextScanner scanner_;
};

template <bool kSwap>
class BinaryValues {
 public:
  explicit BinaryValues(std::string_view bytes)
      : at_(bytes.data()), end_(bytes.data() + bytes.size()) {}

  [[nodiscard]] std::uint64_t remaining() const { return static_cast<std::uint64_t>(end_ - at_); }
  static std::uint64_t smallest_row(const PlyElement& element) {
    std::uint64_t bytes = 0;
    for (const PlyProperty& property : element.properties) {
      bytes += size_of(property.is_list ? property.count_type : property.type);
    }
    return std::max<std::uint64_t>(bytes, 1);
  }
  bool begin_row() { return true; }
  void end_row() {}

  bool real(PlyType type, double& value) { return load(type, value); }
  bool integer(PlyType type, std::int64_t& value) {
    if (type == PlyType::float32 || type == PlyType::float64) {
      double number = 0;
      if (!load(type, number)) return false;
      constexpr double kLargest = 9e15;
      value = std::abs(number) < kLargest ? static_cast<std::int64_t>(number) : kNone;
      return true;
    }
    return load(type, value);
  }
  bool skip(PlyType type, std::int64_t count) {
    if (static_cast<std::uint64_t>(count) > remaining() / size_of(type)) return false;
    at_ += static_cast<std::size_t>(count) * size_of(type);
    return true;
  }

 private:
  template <typename Target>
  bool load(PlyType type, Target& target) {
    if (size_of(type) > remaining()) return false;
    switch (type) {
      case PlyType::int8:
        target = static_cast<Target>(take<std::int8_t>());
        break;
      case PlyType::uint8:
        target = static_cast<Target>(take<std::uint8_t>());
        break;
      case PlyType::int16:
        target = static_cast<Target>(take<std::int16_t>());
        break;
      case PlyType::uint16:
        target = static_cast<Target>(take<std::uint16_t>());
        break;
      case PlyType::int32:
        target = static_cast<Target>(take<std::int32_t>());
        break;
      case PlyType::uint32:
        target = static_cast<Target>(take<std::uint32_t>());
        break;
      case PlyType::float32:
        target = static_cast<Target>(take<float>());
        break;
      case PlyType::float64:
        target = static_cast<Target>(take<double>());
        break;
    }
    return true;
  }

  template <typename Value>
  Value take() {
    std::array<char, sizeof(Value)> raw;
    std::memcpy(raw.data(), at_, sizeof(Value));
    if constexpr (kSwap) {
      for (std::size_t i = 0; i < raw.size() / 2; ++i) std::swap(raw[i], raw[raw.size() - 1 - i]);
    }
    at_ += sizeof(Value);
    return std::bit_cast<Value>(raw);
  }

  const char* at_;
  const char* end_;
};

/// What use(source) gives for the source of the values of a file.
/// \param bytes  the whole file, with its header
template <class Use>
auto with_values(std::string_view bytes, const PlyHeader& header, const Use& use) {
  const std::string_view data = bytes.substr(header.size);
  switch (header.encoding) {
    case PlyEncoding::ascii:
      return use(AsciiValues(data));
    case PlyEncoding::little_endian:
      return use(BinaryValues<false>(data));
    case PlyEncoding::big_endian:
      break;
  }
  return use(BinaryValues<true>(data));
}

}  // namespace strake::meshfile
