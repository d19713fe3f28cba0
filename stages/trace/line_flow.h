#pragma once

#include "stages/trace/arm_bonds.h"
#include "stages/trace/spacing.h"

namespace strake {

/// Changes distances towards those that lines keep by themselves, so that fewer have to end.
///
/// Lines along a unit field d at distances s need no ends where div(d / s) = 0, that is where log s
/// changes along d by div d: they part as they go, or converge. Distances that the tolerance asks
/// for change otherwise. In least squares over the surface, for both families: log s stays as it
/// is, and changes along d by div d, which weighs the square of a length more. Where a family
/// converges faster than by a fifth from cell to cell, as around a singularity, lines end anyway.
///
/// Beyond [MK04]; see [R06], whose correction makes the curl of a whole field vanish.
/// \param cells    that length, in cells of the distances as they are
/// \param spacing  changes by a quarter at most
void follow_lines(const TriMesh& mesh, const PrincipalField& field, const ArmBonds& bonds,
                  double cells, Spacing& spacing);

}  // namespace strake
