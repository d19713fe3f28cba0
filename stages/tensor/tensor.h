#pragma once

#include <optional>

#include "common/core/fields.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct TensorOptions {
  std::optional<Length> radius;  ///< of the averaging ball; default: `ball_rule` in wedge_tensors.h

  OptionList declare();
};

struct TensorResult {
  TensorField field;
  Report report;
};

/// Estimates the curvature tensor of every wedge by normal cycles over a ball.
///
/// Paper: [MK04] section 2 after Cohen-Steiner and Morvan 2003: T = 1/|B| sum of beta |e in B| e
/// e^T. The ball is mesh-connected and does not cross feature edges; |B| is the true area inside.
/// \param coarse  nullptr, or a coarser mesh of `mesh`: its wedges alone get tensors, the same ones
/// \return tensor [W], 1/length, positive where convex
/// Cost O(W * faces per ball). Deterministic for any thread count.
TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options, Observer& observer,
                              const TriMesh* coarse = nullptr);

}  // namespace strake
