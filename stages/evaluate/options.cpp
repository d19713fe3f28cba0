#include "stages/evaluate/evaluate.h"

namespace strake {

OptionList EvaluateOptions::declare() {
  return {
      {.name = "samples",
       .target = &samples,
       .unit = "",
       .help = "Points on each surface from which distances are measured.",
       .min = 1000,
       .max = 1e9},
      {.name = "evaluate-tolerance",
       .target = &tolerance,
       .unit = "length",
       .help = "Fail where result and surface are farther apart than this.",
       .min = 1e-6,
       .max = 0.2},
  };
}

}  // namespace strake
