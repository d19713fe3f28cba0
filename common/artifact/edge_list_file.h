#pragma once

#include <filesystem>
#include <string_view>

#include "common/core/edge_list.h"

namespace strake {

/// Reads a list of edges: text, on each line the numbers of two or more vertices that follow each
/// other, counted from 0 and separated by blanks. "#" begins a comment.
/// \throw InputError naming file, line and remedy
EdgeList read_edge_list(const std::filesystem::path& path);

/// As `read_edge_list`, from text in memory. \param name  of the file, for messages
EdgeList parse_edge_list(std::string_view text, const std::string& name);

}  // namespace strake
