#include "stages/trace/trace.h"

namespace strake {

OptionList TraceOptions::declare() {
  return {
      {.name = "tolerance",
       .target = &tolerance,
       .unit = "length",
       .help = "Wanted distance between surface and result; 0.1% where no count is given either.",
       .min = 1e-6,
       .max = 0.2,
       .one_of = "goal"},
      {.name = "vertices",
       .target = &vertices,
       .unit = "",
       .help = "Wanted number of vertices, instead of a tolerance.",
       .min = 4,
       .max = 1e8,
       .one_of = "goal"},
      {.name = "faces",
       .target = &faces,
       .unit = "",
       .help = "Wanted number of faces, instead of a tolerance.",
       .min = 4,
       .max = 1e8,
       .one_of = "goal"},
      {.name = "spacing-scale",
       .target = &spacing_scale,
       .unit = "",
       .help = "Factor on all distances between lines; 1. Without it, lines for a count are traced "
               "again, up to three times, until they cross about as often.",
       .min = 0.01,
       .max = 100},
      {.name = "max-spacing",
       .target = &max_spacing,
       .unit = "length",
       .help = "Largest distance between neighbouring lines.",
       .min = 0.0001,
       .max = 1},
      {.name = "stop-fraction",
       .target = &stop_fraction,
       .unit = "",
       .help = "A line stops where its neighbour is nearer than this share of the wanted distance; "
               "0.45, with a density 0.6.",
       .min = 0.1,
       .max = 1},
      {.name = "line-flow",
       .target = &line_flow,
       .unit = "",
       .help = "Cells over which distances follow lines that part or converge, so that fewer end; "
               "0: not at all.",
       .min = 0,
       .max = 100},
      {.name = "seed",
       .target = &seed,
       .unit = "",
       .help = "Seed of the random generator that places the first lines.",
       .min = 0},
  };
}

}  // namespace strake
