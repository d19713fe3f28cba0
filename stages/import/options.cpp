#include "stages/import/import.h"

namespace strake {

OptionList ImportOptions::declare() {
  return {
      {.name = "feature-angle",
       .target = &feature_angle_deg,
       .unit = "deg",
       .help =
           "Edges bent by more than this are kept as feature edges, and those bent by more than "
           "half of it that stand alone, as those of chamfers do; 180 keeps none.",
       .min = 0,
       .max = 180},
      {.name = "feature-height",
       .target = &feature_height,
       .unit = "length",
       .help = "Edges are kept, too, that stand out by more than this over the straight way across "
               "their two faces; with --tolerance twice that.",
       .min = 1e-6,
       .max = 1},
      {.name = "facet-height",
       .target = &facet_height,
       .unit = "length",
       .help = "Edges between flat polygons are kept, too, that stand out by more than this, where "
               "nearly all edges are such; with a count above the input's vertices strake remesh "
               "looks whether that is better. 100% keeps none.",
       .min = 1e-6,
       .max = 1},
      {.name = "all-creases",
       .target = &all_creases,
       .unit = "",
       .help =
           "Keep also creases that look like noise: jagged or short ones on rough ground, as the "
           "walls of buildings among measured points have them."},
      {.name = "attribute-features",
       .target = &attribute_features,
       .unit = "",
       .help =
           "Borders that are feature edges too: of labels of faces, seams of texture coordinates, "
           "or both.",
       .choices = {"all", "labels", "seams", "none"}},
      {.name = "no-attributes",
       .target = &no_attributes,
       .unit = "",
       .help = "Leave out colours, texture coordinates and labels of faces."},
      {.name = "denoise",
       .target = &denoise,
       .unit = "N",
       .help =
           "Rounds of smoothing that take noise off a scan, 10 for much of it; where it is rough "
           "creases become round, and distances are those to the smoothed surface.",
       .min = 0,
       .max = 1000},
      {.name = "longest-edge",
       .target = &longest_edge,
       .unit = "length",
       .help = "Longer edges are divided first, so that fields have vertices inside large faces; "
               "the surface stays what it is. 100% divides none.",
       .min = 1e-3,
       .max = 1},
      {.name = "most-removed",
       .target = &most_removed_percent,
       .unit = "%",
       .help =
           "Refuse a mesh of whose surface repairs would remove more than this share of the area; "
           "what is there twice does not count.",
       .min = 0,
       .max = 100},
      {.name = "fill-holes",
       .target = &fill_holes,
       .unit = "length",
       .help = "Fill holes that are at most this far across with faces that go on from the surface "
               "smoothly; where a piece ends, with an outline of more than half its size, stays.",
       .min = 1e-6,
       .max = 1},
      {.name = "outwards",
       .target = &outwards,
       .unit = "",
       .help = "Turn closed components that are inside out over, with what lies inside of them."},
      {.name = "strict",
       .target = &strict,
       .unit = "",
       .help = "Refuse a mesh that would have to be repaired instead of repairing it."},
  };
}

}  // namespace strake
