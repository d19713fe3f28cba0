#include "strake/run/run_paths.h"

#include <nlohmann/json.hpp>
#include <system_error>

#include "common/core/text.h"

namespace strake {

namespace fs = std::filesystem;

fs::path without_dots(const fs::path& path) {
  std::error_code ignored;
  const fs::path normal = path.lexically_normal();
  const auto real = [&](const fs::path& p) { return fs::weakly_canonical(p, ignored) / ""; };
  return real(path) == real(normal) ? normal : path;
}

std::string unfit_for_runs(const fs::path& path) {
  if (has_control_characters(path.string())) return "line breaks or other control characters";
  try {
    static_cast<void>(nlohmann::json(path.string()).dump());
  } catch (const nlohmann::json::type_error&) {
    return "characters that are no UTF-8";
  }
  return "";
}

}  // namespace strake
