#include "stages/decimate/decimate.h"

namespace strake {

OptionList DecimateOptions::declare() {
  return {{.name = "decimate-vertices",
           .target = &vertices,
           .unit = "",
           .help = "Vertices of a result that is made by decimation.",
           .min = 4,
           .max = 1e8}};
}

}  // namespace strake
