#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"

namespace strake::support {

/// A circle in the plane, as a regular polygon.
struct Disk {
  Vec2 centre;
  double radius = 1;
  int sides = 24;
};

/// A closed box one unit thick, its upper side [-half, half]^2 at z = 0, with a pit at each disk.
/// \pre the disks lie inside and do not touch
PolyMesh pitted_plate(double half, const std::vector<Disk>& disks, double depth);

}  // namespace strake::support
