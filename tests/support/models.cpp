#include "tests/support/models.h"

#include <cstdlib>

namespace strake::support {

std::filesystem::path models_folder() {
  const char* set = std::getenv("STRAKE_MODELS");
  const std::filesystem::path folder =
      set != nullptr && *set != '\0'
          ? std::filesystem::path(set)
          : std::filesystem::path(STRAKE_SOURCE_DIR) / ".." / "shared" / "models";
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored)) return {};
  return std::filesystem::weakly_canonical(folder);
}

}  // namespace strake::support
