#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace strake::report {

/// What the viewer needs to find and decode an array.
struct Block {
  const char* codec = "";  ///< "vertices" or "triangles"
  std::size_t at = 0;      ///< first byte
  std::size_t bytes = 0;
  std::size_t count = 0;   ///< rows, or corners
  std::size_t stride = 0;  ///< bytes of a row, or of a corner
};
void to_json(nlohmann::ordered_json& json, const Block& block);

/// The binary part of a report: arrays, coded by meshoptimizer, one after the other.
class Blocks {
 public:
  /// Adds rows of a multiple of four bytes, at most 256. Rows come out bit for bit.
  template <class Row>
  Block vertices(const std::vector<Row>& rows) {
    static_assert(sizeof(Row) % 4 == 0 && sizeof(Row) <= 256 && std::is_trivially_copyable_v<Row>);
    return rows_of(rows.data(), rows.size(), sizeof(Row));
  }
  /// Adds corners of triangles. Triangles keep their order and their sense; which of its corners
  /// comes first may change.
  Block triangles(std::span<const std::uint32_t> corners);

  /// All blocks, deflated as one (RFC 1950), in base64: meshoptimizer leaves that to others, and
  /// its codes for triangles in no order at all are a third smaller for it.
  [[nodiscard]] std::string packed() const;
  [[nodiscard]] std::size_t size() const { return bytes_.size(); }

 private:
  Block rows_of(const void* rows, std::size_t count, std::size_t stride);
  Block append(const char* codec, const std::vector<unsigned char>& encoded, std::size_t count,
               std::size_t stride);

  std::vector<unsigned char> bytes_;
};

}  // namespace strake::report
