#include "stages/tensor/tensor.h"

namespace strake {

OptionList TensorOptions::declare() {
  return {
      {.name = "radius",
       .target = &radius,
       .unit = "length",
       .help = "Radius of the ball over which curvature is averaged; larger for noisy scans.",
       .min = 0.0001,
       .max = 0.5},
  };
}

}  // namespace strake
