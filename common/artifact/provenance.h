#pragma once

#include <string>
#include <vector>

#include "common/core/options.h"

namespace strake {

/// How an artifact was made: enough to make it again. Holds no times, hosts or paths, so that equal
/// work gives equal bytes.
struct Provenance {
  struct OptionRecord {
    std::string name;
    std::string value;  ///< as `Option::value` writes it
    bool is_default = true;
    friend bool operator==(const OptionRecord&, const OptionRecord&) = default;
  };
  struct InputRecord {
    std::string role;    ///< "mesh", "field", ...
    std::string digest;  ///< `content_digest` of the file read
    friend bool operator==(const InputRecord&, const InputRecord&) = default;
  };

  std::string stage;
  int stage_version = 0;  ///< raised whenever a stage's result changes for equal inputs
  std::vector<OptionRecord> options;
  std::vector<InputRecord> inputs;

  [[nodiscard]] std::string to_json() const;
  /// \throw InputError where the text is not what `to_json` writes
  static Provenance from_json(const std::string& text);
  friend bool operator==(const Provenance&, const Provenance&) = default;
};

}  // namespace strake
