#pragma once

#include <string>

#include "common/core/poly_mesh.h"
#include "common/core/report.h"

namespace strake {

/// A few lines about a result for the user.
/// \param measures  report of the stage "evaluate"; nullptr: counts only
std::string summary_text(const std::string& output, const PolyMesh& mesh, const Report* measures);

}  // namespace strake
