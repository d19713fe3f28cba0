#include "common/artifact/meshfile/density_reader.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/artifact/meshfile/mapped_file.h"
#include "common/artifact/meshfile/ply_header.h"
#include "common/artifact/meshfile/ply_row.h"
#include "common/artifact/meshfile/ply_values.h"
#include "common/core/error.h"
#include "common/core/text.h"

namespace strake {
namespace {

using namespace meshfile;

constexpr const char* kProperty = "density";

/// The columns of the density and, where there are all three, of x, y and z.
/// \return none: there is no density
std::vector<std::size_t> wanted_columns(const PlyElement& element) {
  std::vector<std::size_t> columns;
  for (const char* name : {kProperty, "x", "y", "z"}) {
    const auto column = number_column(element, name);
    if (!column) break;
    columns.push_back(*column);
  }
  if (columns.size() < 4 && !columns.empty()) columns.resize(1);
  return columns;
}

template <class Source>
DensityField read_vertices(Source source, const PlyHeader& header) {
  for (const PlyElement& element : header.elements) {
    std::vector<std::size_t> wanted;
    if (element.properties.empty()) continue;  // any number of rows of no bytes
    if (element.name == "vertex") {
      wanted = wanted_columns(element);
      if (wanted.empty()) break;
    }
    DensityField density;
    for (std::uint64_t row = 0; row < element.count; ++row) {
      std::array<double, 4> values{};
      if (!read_row(source, element, wanted, values)) {
        throw InputError(fmt::format("ends before vertex {} of {}", row, element.count));
      }
      if (wanted.empty()) continue;
      if (!(values[0] > 0) || !std::isfinite(values[0])) {
        throw InputError(fmt::format(
            "has the density {} at vertex {}; it must be a positive number", values[0], row));
      }
      density.value.push_back(values[0]);
      if (wanted.size() == values.size()) {
        density.position.emplace_back(values[1], values[2], values[3]);
      }
    }
    if (!wanted.empty()) return density;
  }
  throw InputError(fmt::format("has no vertex property '{}'", kProperty));
}

}  // namespace

DensityField parse_density(std::string_view bytes) {
  bytes = without_byte_order_mark(bytes);
  if (!bytes.starts_with("ply")) throw InputError("is no PLY file, which alone can hold a density");
  ReadReport report;
  const PlyHeader header = read_ply_header(bytes, report);
  return with_values(bytes, header,
                     [&](const auto& source) { return read_vertices(source, header); });
}

DensityField read_density(const std::filesystem::path& path) {
  const MappedFile file(path);
  try {
    return parse_density(file.bytes());
  } catch (const InputError& error) {
    throw InputError(fmt::format("'{}' {}", path.string(), error.what()));
  }
}

}  // namespace strake
