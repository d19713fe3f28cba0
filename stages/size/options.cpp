#include "stages/size/size.h"

namespace strake {

OptionList SizeOptions::declare() {
  return {
      {.name = "size-tolerance",
       .target = &tolerance,
       .unit = "length",
       .help = "Error to aim at where it is exceeded; without it the mean error, so that errors "
               "become even.",
       .min = 1e-7,
       .max = 0.2},
      {.name = "feedback",
       .target = &feedback,
       .unit = "",
       .help = "Distances of lines change with this power of the error; 0.33, with a density 0.4.",
       .min = 0,
       .max = 1},
  };
}

}  // namespace strake
