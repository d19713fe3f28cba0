#include "stages/import/import.h"

namespace strake {

OptionList ImportOptions::declare() {
  return {
      {.name = "feature-angle",
       .target = &feature_angle_deg,
       .unit = "deg",
       .help = "Edges bent by more than this are kept as feature edges; 180 keeps none.",
       .min = 0,
       .max = 180},
      {.name = "strict",
       .target = &strict,
       .unit = "",
       .help = "Refuse a mesh that would have to be repaired instead of repairing it."},
  };
}

}  // namespace strake
