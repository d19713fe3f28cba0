#pragma once

#include <cstdint>
#include <vector>

#include "common/core/fields.h"
#include "common/core/mesh_blocks.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tensor_part.h"
#include "stages/tensor/tensor.h"

namespace strake {

struct TensorPartOptions {
  TensorOptions tensor;
  std::int64_t parts = 1;  ///< that the mesh is divided into
  std::int64_t part = 1;   ///< which of them, from 1

  /// Those of `tensor`, then `parts` and `part`.
  OptionList declare();
};

struct TensorPartResult {
  TensorPart part;
  Report report;
};

/// Estimates the tensors of one part of a mesh, in memory for that part and its surroundings.
///
/// Every wedge gets the same bits as from `estimate_tensors`: see `estimate_wedge_tensors`.
/// \throw UsageError where there are fewer parts than `part`
TensorPartResult estimate_tensor_part(const MeshBlocks& blocks, const TensorPartOptions& options,
                                      Observer& observer);

/// Puts the parts of a mesh of `wedges` wedges together, given in any order.
/// \return what `estimate_tensors` gives for that mesh
/// \pre the parts are of that mesh
/// \throw PreconditionError where a part is missing or there twice, where parts are of different
///        divisions, or where they do not hold every wedge once
TensorField merge_tensor_parts(const std::string& mesh_id, Index wedges,
                               const std::vector<const TensorPart*>& parts);

}  // namespace strake
