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
  };
}

}  // namespace strake
