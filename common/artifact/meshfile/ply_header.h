#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/artifact/meshfile/mesh_reader.h"

namespace strake::meshfile {

enum class PlyType { int8, uint8, int16, uint16, int32, uint32, float32, float64 };
enum class PlyEncoding { ascii, little_endian, big_endian };

/// Bytes of a value in binary files.
constexpr std::size_t size_of(PlyType type) {
  switch (type) {
    case PlyType::int8:
    case PlyType::uint8:
      return 1;
    case PlyType::int16:
    case PlyType::uint16:
      return 2;
    case PlyType::int32:
    case PlyType::uint32:
    case PlyType::float32:
      return 4;
    case PlyType::float64:
      break;
  }
  return 8;
}

struct PlyProperty {
  std::string name;
  PlyType type = PlyType::float32;
  bool is_list = false;
  PlyType count_type = PlyType::uint8;  ///< of lists
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyEncoding encoding = PlyEncoding::ascii;
  std::vector<PlyElement> elements;
  std::size_t size = 0;  ///< bytes up to the data
};

/// Lines with unknown keywords are skipped and counted.
/// \throw InputError without the file's name where the header has no end or makes no sense
PlyHeader read_ply_header(std::string_view bytes, ReadReport& report);

}  // namespace strake::meshfile
