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
      {.name = "odd-price",
       .target = &odd_price,
       .unit = "",
       .help = "Price of a face that is no quad: the higher, the farther lines are prolonged or "
               "taken back to make quads; 0 leaves faces as the lines made them.",
       .min = 0,
       .max = 1000},
      {.name = "valence-price",
       .target = &valence_price,
       .unit = "",
       .help = "Price of an edge that a vertex has too many or too few: the higher, the more quads "
               "are divided anew to make vertices of four; 0 leaves them.",
       .min = 0,
       .max = 1000},
      {.name = "corner-distance",
       .target = &corner_distance,
       .unit = "",
       .help = "Corners of feature and boundary lines merge only where that leaves them this near "
               "to these lines, in wanted edge lengths. strake remesh takes 1 where there are too "
               "many for a wanted count.",
       .min = 0,
       .max = 1},
      {.name = "pure-quads",
       .target = &pure_quads,
       .unit = "",
       .help = "Make every face a quad, at the price of more vertices of valence 3 and 5."},
      {.name = "border-distance",
       .target = &border_distance,
       .unit = "length",
       .help = "Saws that boundaries cut along triangles have are left out up to this height over "
               "the middle, at most 0.75% of the diagonal, where they are finer than "
               "cells. strake remesh takes half the tolerance.",
       .min = 1e-7,
       .max = 1},
      {.name = "strip-vertices",
       .target = &strip_vertices,
       .unit = "",
       .help = "Come nearer to this number of vertices by splitting strips of quads, or by taking "
               "them out; 0 leaves what the lines give. strake remesh sets it for a wanted count.",
       .min = 0,
       .max = 2e9},
  };
}

}  // namespace strake
