#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stages between the mesh and a result that meets a goal. Copies share option values.
struct GoalStages {
  Stage coarsen;
  Stage tensor;
  Stage smooth;
  Stage trace;
  Stage mesh;
  Stage lift;
  Stage prolong;
  Stage fit;
  Stage size;
  Stage refine;
  Stage uncross;
  Stage worst;
  Stage decimate;
};

}  // namespace strake
