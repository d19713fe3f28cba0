#include "stages/smooth/smooth.h"

namespace strake {

OptionList SmoothOptions::declare() {
  return {
      {.name = "iterations",
       .target = &iterations,
       .unit = "",
       .help = "Rounds of smoothing that carry directions from confident into doubtful areas.",
       .min = 0,
       .max = 1000},
      {.name = "extension",
       .target = &extension,
       .unit = "",
       .help = "Directions in doubtful areas: 'cross' continues them smoothly up to right angles, "
               "'paper' uses the smoothed tensors alone.",
       .choices = {"cross", "paper"}},
      {.name = "field-stiffness",
       .target = &field_stiffness,
       .unit = "",
       .help = "How strongly the cross field holds to the curvature directions.",
       .min = 0,
       .max = 1e6},
      {.name = "guide-reach",
       .target = &guide_reach,
       .unit = "length",
       .help = "Around a guide line, within which edges follow it instead of the curvature.",
       .min = 0,
       .max = 1},
  };
}

}  // namespace strake
