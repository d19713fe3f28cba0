#pragma once

#include <optional>

#include "common/core/fields.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"
#include "stages/tensor/wedge_tensors.h"

namespace strake {

struct TensorOptions {
  std::optional<Length> radius;  ///< of the averaging ball; default see `ball_rule`

  OptionList declare();
};

/// Radius of the averaging balls, and how many faces they hold.
///
/// Where no radius is asked for it is 1 % of the diagonal. Beyond two million faces it falls with
/// their edges, so that a ball does not hold more and more of them: time would grow with their
/// square, to average away what such a scan shows. Nor does a ball hold more than some thousand
/// faces, as it would where most of a mesh is small against its diagonal. \param diagonal  of the
/// bounding box, model units
BallRule ball_rule(const TensorOptions& options, double diagonal, Index faces);

struct TensorResult {
  TensorField field;
  Report report;
};

/// Estimates the curvature tensor of every wedge by normal cycles over a ball.
///
/// Paper: [MK04] section 2 after Cohen-Steiner and Morvan 2003: T = 1/|B| sum of beta |e in B| e
/// e^T. The ball is mesh-connected and does not cross feature edges; |B| is the true area inside.
/// \return tensor [W], 1/length, positive where convex
/// Cost O(W * faces per ball). Deterministic for any thread count.
TensorResult estimate_tensors(const TriMesh& mesh, const TensorOptions& options,
                              Observer& observer);

}  // namespace strake
