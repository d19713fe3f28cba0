#include "stages/fit/fit.h"

namespace strake {

OptionList FitOptions::declare() {
  return {
      {.name = "fit-rounds",
       .target = &rounds,
       .unit = "",
       .help =
           "Times that distances are measured and vertices moved; 0 leaves them on the surface.",
       .min = 0,
       .max = 20},
  };
}

}  // namespace strake
