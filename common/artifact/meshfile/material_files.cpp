#include "common/artifact/meshfile/material_files.h"

#include <sstream>

namespace strake {
namespace {

namespace fs = std::filesystem;

/// The folder a file is in, links followed where it can be looked at.
fs::path folder_of(const fs::path& file) {
  std::error_code error;
  const fs::path folder = fs::absolute(file, error).parent_path();
  const fs::path canonical = fs::weakly_canonical(folder, error);
  return error ? folder : canonical;
}

std::vector<std::string> files_of(const std::string& statement, const fs::path& folder) {
  std::error_code ignored;
  if (fs::exists(folder / statement, ignored)) return {statement};
  std::vector<std::string> files;
  std::istringstream words(statement);
  for (std::string word; words >> word;) files.push_back(word);
  return files;
}

}  // namespace

std::vector<std::string> material_files_seen_from(const std::vector<std::string>& statements,
                                                  const fs::path& from, const fs::path& to) {
  const fs::path here = folder_of(from);
  const fs::path there = folder_of(to);
  if (here == there) return statements;
  std::vector<std::string> seen;
  for (const std::string& statement : statements) {
    for (const std::string& file : files_of(statement, here)) {
      seen.push_back(fs::path(file).is_absolute()
                         ? file
                         : (here / file).lexically_proximate(there).generic_string());
    }
  }
  return seen;
}

}  // namespace strake
