#pragma once

#include <string>

#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/geometry/samples/samples.h"

namespace strake {

struct SampleStageOptions {
  std::string kind = "part";  ///< one of `sample_names`
  SampleOptions sample;

  OptionList declare();
};

/// Makes the surface. \throw UsageError, AlgorithmError as `make_sample`
PolyMesh sample_surface(const SampleStageOptions& options);

}  // namespace strake
