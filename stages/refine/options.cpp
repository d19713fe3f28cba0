#include "stages/refine/refine.h"
#include "stages/refine/worst.h"

namespace strake {

OptionList RefineOptions::declare() {
  return {
      {.name = "refine-tolerance",
       .target = &tolerance,
       .unit = "length",
       .help = "Divide cells that are farther than this from the surface, until none is.",
       .min = 1e-6,
       .max = 0.2,
       .one_of = "goal"},
      {.name = "refine-vertices",
       .target = &vertices,
       .unit = "",
       .help = "Divide the cells farthest from the surface, up to about this number of vertices.",
       .min = 4,
       .max = 1e8,
       .one_of = "goal"},
      {.name = "refine-sides",
       .target = &sides,
       .unit = "",
       .help = "Largest number of corners that a face beside a divided cell may get; larger ones "
               "are divided, too. 5; strake remesh takes --max-sides.",
       .min = 4,
       .max = 64},
      {.name = "refine-rounds",
       .target = &rounds,
       .unit = "",
       .help = "Times that cells are measured and divided.",
       .min = 0,
       .max = 100},
      {.name = "refine-partly",
       .target = &partly,
       .unit = "",
       .help = "Hand on the result also where it is not within the tolerance yet."},
  };
}

OptionList WorstOptions::declare() {
  return {{.name = "worst-share",
           .target = &share,
           .unit = "",
           .help = "Vertices that may be added where a result is farthest from the surface, as a "
                   "share of those there are; 0: it stays as it is.",
           .min = 0,
           .max = 1}};
}

}  // namespace strake
