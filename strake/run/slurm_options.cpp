#include "strake/run/slurm_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>
#include <vector>

namespace strake {
namespace {

/// Tasks, their order and the way back from a job to its run hang on these.
const std::vector<std::string> kOwnOptions = {
    "--array",    "-a", "--dependency", "-d",         "--chdir",
    "-D",         "-o", "--output",     "--parsable", "--wrap",
    "--clusters", "-M", "--wait",       "-W",         "--kill-on-invalid-dep"};

}  // namespace

std::string checked_sbatch_options(const std::string& text, const Place& place) {
  const bool has_control =
      std::any_of(text.begin(), text.end(), [](unsigned char c) { return c < ' '; });
  if (text.empty() || text.front() != '-' || has_control) {
    place.fail(fmt::format("'{}' is no option of sbatch; write e.g. --partition=long", text));
  }
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    // A short option may have its value at once: "-d5".
    const bool is_long = word.rfind("--", 0) == 0;
    const std::string option = is_long ? word.substr(0, word.find('=')) : word.substr(0, 2);
    // sbatch takes the beginning of a long one for all of it.
    const auto is_meant = [&](const std::string& own) {
      return is_long ? own.rfind(option, 0) == 0 : own == option;
    };
    if (std::any_of(kOwnOptions.begin(), kOwnOptions.end(), is_meant)) {
      place.fail(fmt::format("'{}' cannot be set: strake needs it for itself", option));
    }
  }
  return text;
}

}  // namespace strake
