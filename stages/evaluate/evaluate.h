#pragma once

#include <cstdint>
#include <optional>

#include "common/core/fields.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct EvaluateOptions {
  std::int64_t samples = 200000;    ///< of each surface, for distances
  std::optional<Length> tolerance;  ///< two-sided distance beyond which it is an error

  OptionList declare();
};

struct EvaluateResult {
  Report report;
};

/// Measures a polygon mesh against the surface it approximates.
/// \param field  curvature directions for the alignment figures; nullptr: these are left out
/// \throw PreconditionError where the candidate cannot be measured, ToleranceError naming the
///        farthest place where that is beyond the tolerance
EvaluateResult evaluate_mesh(const TriMesh& reference, const PrincipalField* field,
                             const PolyMesh& candidate, const EvaluateOptions& options,
                             Observer& observer);

}  // namespace strake
