#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/artifact/provenance.h"
#include "common/core/report.h"

namespace strake {

/// What one stage did and said. Holds no times, so that equal work gives equal text.
struct StageRecord {
  Provenance provenance;
  Report report;
};

/// A stage's record as JSON, dotted keys nested: "stage", "stage_version", "options", "inputs",
/// "result", "warnings".
std::string record_json(const StageRecord& record);

/// Records of a whole pipeline as a JSON object by stage name.
std::string records_json(const std::vector<StageRecord>& records);

/// Seconds that stages took, by their names: {"seconds": {...}}.
std::string times_json(const std::map<std::string, double>& seconds);

/// The seconds that `times_json` wrote; nothing where it did not write the text.
std::optional<std::map<std::string, double>> read_times(const std::string& text);

/// One "key: value" line per entry, in order, values aligned.
std::string report_text(const Report& report);

/// A value as people read it: shortest text, six digits of a number with a fraction.
std::string value_text(const Report::Value& value);

}  // namespace strake
