#pragma once

#include "common/core/fields.h"
#include "common/core/guides.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct SmoothOptions {
  std::int64_t iterations = 5;      ///< of the operator of [MK04] section 4.1
  std::string extension = "cross";  ///< "cross": smooth cross field; "paper": tensors only
  double field_stiffness = 2000;    ///< how strongly `cross` holds to the curvature directions
  Length guide_reach = percent(5);  ///< around a guide, within which it decides, not the curvature

  OptionList declare();
};

struct SmoothResult {
  PrincipalField field;
  Report report;
};

/// Smooths curvature tensors from confident into non-confident areas and extracts their frames.
/// Paper: [MK04] section 4.1 (confidence, operator) and section 2 (frame realignment).
/// Deterministic for any thread count.
/// \param tensor  given up to spare its memory
/// \param guides  lines that `cross` is to follow; nullptr for none
/// \throw UsageError where there are guides but no cross field; InputError where a guide is too far
///        from the surface
SmoothResult smooth_tensors(const TriMesh& mesh, TensorField tensor, const SmoothOptions& options,
                            Observer& observer, const GuideLines* guides = nullptr);

}  // namespace strake
