#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "common/artifact/meshfile/ply_header.h"

/// Some numbers of each row of a PLY element, for what is no mesh.
namespace strake::meshfile {

/// Place of a property that is a single number; nullopt where the element has none of that name.
inline std::optional<std::size_t> number_column(const PlyElement& element, std::string_view name) {
  const auto found = std::find_if(element.properties.begin(), element.properties.end(),
                                  [&](const PlyProperty& p) { return p.name == name; });
  if (found == element.properties.end() || found->is_list) return std::nullopt;
  return static_cast<std::size_t>(found - element.properties.begin());
}

/// Reads a row from a source of ply_values.h.
/// \param columns  places of the properties to keep, single numbers
/// \param values   receives them
/// \return false where the data ends
template <class Source>
bool read_row(Source& source, const PlyElement& element, std::span<const std::size_t> columns,
              std::span<double> values) {
  if (!source.begin_row()) return false;
  for (std::size_t p = 0; p < element.properties.size(); ++p) {
    const PlyProperty& property = element.properties[p];
    std::int64_t count = 1;
    if (property.is_list && !(source.integer(property.count_type, count) && count >= 0)) {
      return false;
    }
    const auto column = std::find(columns.begin(), columns.end(), p);
    if (column != columns.end()) {
      if (!source.real(property.type, values[column - columns.begin()])) return false;
    } else if (!source.skip(property.type, count)) {
      return false;
    }
  }
  source.end_row();
  return true;
}

}  // namespace strake::meshfile
