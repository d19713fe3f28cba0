#pragma once

#include <meshoptimizer.h>
#include <zlib.h>

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "strake/report/blocks.h"

/// Reads blocks of a report as the viewer does, with zlib and the decoder of meshoptimizer.
namespace strake::report_test {

/// Bytes of a base64 text. \throw std::invalid_argument where it is none
inline std::vector<unsigned char> from_base64(const std::string& text) {
  static const std::string kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  if (text.size() % 4 != 0) throw std::invalid_argument("length");
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i < text.size(); i += 4) {
    unsigned group = 0;
    int padding = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      const char c = text[i + k];
      if (c == '=' && i + 4 == text.size() && k >= 2) {
        ++padding;
        group <<= 6;
        continue;
      }
      const std::size_t digit = kDigits.find(c);
      if (digit == std::string::npos || padding > 0) throw std::invalid_argument("digit");
      group = group << 6 | static_cast<unsigned>(digit);
    }
    for (int k = 0; k < 3 - padding; ++k) {
      bytes.push_back(static_cast<unsigned char>(group >> (16 - 8 * k)));
    }
  }
  return bytes;
}

/// The bytes that blocks were packed from. \throw std::runtime_error where they do not come back
inline std::vector<unsigned char> unpacked(const report::Blocks& blocks) {
  const std::vector<unsigned char> packed = from_base64(blocks.packed());
  std::vector<unsigned char> bytes(blocks.size() + 1);  // more would show
  uLongf size = bytes.size();
  if (uncompress(bytes.data(), &size, packed.data(), packed.size()) != Z_OK) {
    throw std::runtime_error("zlib");
  }
  bytes.resize(size);
  return bytes;
}

/// Rows of a block. \throw std::runtime_error where it cannot be decoded
template <class Row>
std::vector<Row> decode(const nlohmann::ordered_json& block,
                        const std::vector<unsigned char>& bytes) {
  std::vector<Row> rows(block.at("count").get<std::size_t>());
  if (block.at("stride") != sizeof(Row)) throw std::runtime_error("stride");
  if (rows.empty()) return rows;
  const unsigned char* data = bytes.data() + block.at("at").get<std::size_t>();
  const auto size = block.at("bytes").get<std::size_t>();
  const int failed =
      block.at("codec") == "triangles"
          ? meshopt_decodeIndexBuffer(rows.data(), rows.size(), sizeof(Row), data, size)
          : meshopt_decodeVertexBuffer(rows.data(), rows.size(), sizeof(Row), data, size);
  if (failed != 0) throw std::runtime_error("codec");
  return rows;
}

}  // namespace strake::report_test
