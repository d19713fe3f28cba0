#include "strake/report/blocks.h"

#include <meshoptimizer.h>
#include <zlib.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/core/error.h"

namespace strake::report {
namespace {

std::vector<unsigned char> deflated(const std::vector<unsigned char>& bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<unsigned char> result(size);
  if (compress2(result.data(), &size, bytes.data(), bytes.size(), Z_BEST_COMPRESSION) != Z_OK) {
    throw AlgorithmError("a report cannot be compressed");
  }
  result.resize(size);
  return result;
}

std::string base64(const std::vector<unsigned char>& bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? bytes[i + k] : 0u);
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

}  // namespace

void to_json(nlohmann::ordered_json& json, const Block& block) {
  json = {{"codec", block.codec},
          {"at", block.at},
          {"bytes", block.bytes},
          {"count", block.count},
          {"stride", block.stride}};
}

Block Blocks::append(const char* codec, const std::vector<unsigned char>& encoded,
                     std::size_t count, std::size_t stride) {
  const Block block{codec, bytes_.size(), encoded.size(), count, stride};
  bytes_.insert(bytes_.end(), encoded.begin(), encoded.end());
  return block;
}

Block Blocks::rows_of(const void* rows, std::size_t count, std::size_t stride) {
  std::vector<unsigned char> encoded;
  if (count > 0) {
    encoded.resize(meshopt_encodeVertexBufferBound(count, stride));
    encoded.resize(meshopt_encodeVertexBuffer(encoded.data(), encoded.size(), rows, count, stride));
  }
  return append("vertices", encoded, count, stride);
}

Block Blocks::triangles(std::span<const std::uint32_t> corners) {
  std::vector<unsigned char> encoded;
  if (!corners.empty()) {
    const std::size_t vertex_count = *std::max_element(corners.begin(), corners.end()) + 1;
    encoded.resize(meshopt_encodeIndexBufferBound(corners.size(), vertex_count));
    encoded.resize(
        meshopt_encodeIndexBuffer(encoded.data(), encoded.size(), corners.data(), corners.size()));
  }
  return append("triangles", encoded, corners.size(), sizeof(std::uint32_t));
}

std::string Blocks::packed() const { return base64(deflated(bytes_)); }

}  // namespace strake::report
