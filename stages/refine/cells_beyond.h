#pragma once

#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"

namespace strake {

/// A cell to be divided.
struct Target {
  Index face = kNone;
  double distance = 0;  ///< that it is off by
};

/// The cells to divide so that no place is beyond the tolerance any more, ascending.
/// \param excess      of `quads`, a result of `mesh`
/// \param on_surface  whether places of the input are those of the cells around the vertex that is
///                    nearest over the surface, rather than of the cell that is nearest in space
std::vector<Target> cells_beyond(const TriMesh& mesh, const QuadMesh& quads,
                                 const std::vector<Excess>& excess, bool on_surface);

/// Leaves out cells that are too small for dividing them to bring places of the input nearer: in
/// folds it would go on for ever, and more and more faces cross.
/// \param mesh       of the result
/// \param excess     what the cells are to be divided for
/// \param tolerance  model units
std::vector<Target> large_enough(const ComparedSurfaces& surfaces, const PolyMesh& mesh,
                                 const std::vector<Excess>& excess, double tolerance,
                                 std::vector<Target> targets);

/// All cells of a result, those that are farthest off first.
std::vector<Target> cells_by_distance(const ErrorMap& errors);

}  // namespace strake
