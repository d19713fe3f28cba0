#include "stages/tensor/tensor.h"
#include "stages/tensor/tensor_part.h"

namespace strake {

OptionList TensorOptions::declare() {
  return {
      {.name = "radius",
       .target = &radius,
       .unit = "length",
       .help =
           "Radius of the ball over which curvature is averaged; larger for noisy scans. 1% where "
           "none is given, of meshes of more than two million faces less.",
       .min = 0.0001,
       .max = 0.5},
  };
}

OptionList TensorPartOptions::declare() {
  constexpr double kMostParts = 4096;
  OptionList options = tensor.declare();
  options.push_back({.name = "parts",
                     .target = &parts,
                     .unit = "",
                     .help = "Parts that the mesh is divided into, one process each.",
                     .min = 1,
                     .max = kMostParts});
  options.push_back({.name = "part",
                     .target = &part,
                     .unit = "",
                     .help = "Number of the part to do.",
                     .min = 1,
                     .max = kMostParts});
  return options;
}

}  // namespace strake
