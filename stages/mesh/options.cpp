#include "stages/mesh/mesh.h"

namespace strake {

OptionList MeshOptions::declare() {
  return {
      {.name = "max-sides",
       .target = &max_sides,
       .unit = "",
       .help = "Largest number of corners of a face; larger cells are divided.",
       .min = 4,
       .max = 64},
  };
}

}  // namespace strake
