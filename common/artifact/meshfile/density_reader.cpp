#include "common/artifact/meshfile/density_reader.h"

#include <fmt/format.h>

#include <cmath>

#include "common/artifact/meshfile/mapped_file.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_row.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/core/error.h"

namespace strake {
namespace {

using namespace meshfile;

constexpr const char* kProperty = "density";

template <class Source>
std::vector<double> read_vertices(Source source, const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    std::vector<std::size_t> wanted;
    if (element.properties.empty()) continue;  // any number of rows of no bytes
    if (element.name == "vertex") {
      const auto column = number_column(element, kProperty);
      if (!column) break;
      wanted = {*column};
    }
    std::vector<double> values;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      double value = 0;
      if (!read_row(source, element, wanted, {&value, 1})) {
        throw InputError(fmt::format("ends before vertex {} of {}", row, element.count));
      }
      if (wanted.empty()) continue;
      if (!(value > 0) || !std::isfinite(value)) {
        throw InputError(fmt::format(
            "has the density {} at vertex {}; it must be a positive number", value, row));
      }
      values.push_back(value);
    }
    if (!wanted.empty()) return values;
  }
  throw InputError(fmt::format("has no vertex property '{}'", kProperty));
}

}  // namespace

std::vector<double> parse_density(std::string_view bytes) {
  if (!bytes.starts_with("ply")) throw InputError("is no PLY file, which alone can hold a density");
  ReadReport report;
  const PlyHeader header = read_ply_header(bytes, report);
  return with_values(bytes, header,
                     [&](const auto& source) { return read_vertices(source, header); });
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
