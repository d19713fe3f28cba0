#include "stages/coarsen/coarsen.h"

namespace strake {

OptionList CoarsenOptions::declare() {
  return {{.name = "coarse-vertices",
           .target = &vertices,
           .unit = "",
           .help =
               "Vertices of the coarser mesh beside those on feature and boundary lines, which all "
               "stay.",
           .min = 4,
           .max = 1e9}};
}

}  // namespace strake
