#include "common/artifact/meshfile/density_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/artifact/meshfile/mapped_file.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/core/error.h"

namespace strake {
namespace {

using namespace meshfile;

constexpr const char* kProperty = "density";

/// Reads a row of values. \param wanted  receives the property of that index; -1: none
template <class Source>
bool read_row(Source& source, const PlyElement& element, std::ptrdiff_t wanted, double& value) {
  if (!source.begin_row()) return false;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    std::int64_t count = 1;
    if (property.is_list && !(source.integer(property.count_type, count) && count >= 0)) {
      return false;
    }
    if (static_cast<std::ptrdiff_t>(p) == wanted) {
      if (!source.real(property.type, value)) return false;
    } else if (!source.skip(property.type, count)) {
      return false;
    }
  }
  source.end_row();
  return true;
}

template <class Source>
std::vector<double> read_vertices(Source source, const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    std::ptrdiff_t wanted = -1;
    if (element.name == "vertex") {
      const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                      [](const PlyProperty& p) { return p.name == kProperty; });
      if (found == element.properties.end() || found->is_list) break;
      wanted = found - element.properties.begin();
    }
    std::vector<double> values;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      double value = 0;
      if (!read_row(source, element, wanted, value)) {
        throw InputError(fmt::format("ends before vertex {} of {}", row, element.count));
      }
      if (wanted < 0) continue;
      if (!(value > 0) || !std::isfinite(value)) {
        throw InputError(fmt::format(
            "has the density {} at vertex {}; it must be a positive number", value, row));
      }
      values.push_back(value);
    }
    if (wanted >= 0) return values;
  }
  throw InputError(fmt::format("has no vertex property '{}'", kProperty));
}

}  // namespace

std::vector<double> parse_density(std::string_view bytes) {
  if (!bytes.starts_with("ply")) throw InputError("is no PLY file, which alone can hold a density");
  ReadReport report;
  const PlyHeader header = read_ply_header(bytes, report);
  const std::string_view data = bytes.substr(header.size);
  switch (header.encoding) {
    case PlyEncoding::ascii:
      return read_vertices(AsciiValues(data), header);
    case PlyEncoding::little_endian:
      return read_vertices(BinaryValues<false>(data), header);
    case PlyEncoding::big_endian:
      break;
  }
  return read_vertices(BinaryValues<true>(data), header);
}

std::vector<double> read_density(const std::filesystem::path& path) {
  const MappedFile file(path);
  try {
    return parse_density(file.bytes());
  } catch (const InputError& error) {
    throw InputError(fmt::format("'{}' {}", path.string(), error.what()));
  }
}

}  // namespace strake
