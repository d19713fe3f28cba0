#pragma once

#include "stages/trace/arm_bonds.h"

namespace strake {

struct Spacing;

/// Lowers distances as little as it takes for them to change by at most `gradation` times the way
/// on the surface along bonds, to be the same across features, and to have a ratio of at most 2 at
/// wedges where curvature asks for none. Works in parallel.
void grade_spacing(const ArmBonds& bonds, double gradation, Spacing& spacing);

}  // namespace strake
