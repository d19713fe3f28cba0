#pragma once

#include "common/stage/stage.h"

namespace strake {

/// The stages that are run again and again until a goal is met. Copies share option values.
struct GoalStages {
  Stage coarsen;
  Stage restrict;
  Stage trace;
  Stage mesh;
  Stage lift;
  Stage fit;
  Stage size;
  Stage refine;
  Stage decimate;
};

}  // namespace strake
