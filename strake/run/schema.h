#pragma once

#include <string>

namespace strake {

/// The JSON Schema of pipeline files, for editors; derived from the stages' declared options.
/// `read_description` checks more than it can say.
std::string pipeline_schema();

}  // namespace strake
