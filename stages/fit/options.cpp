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
      {.name = "keep-flats",
       .target = &keep_flats,
       .unit = "",
       .help =
           "Leave vertices inside flats where lines put them, instead of spreading them evenly; "
           "a density implies it."},
  };
}

}  // namespace strake
