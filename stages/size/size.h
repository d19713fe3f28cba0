#pragma once

#include <optional>

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct SizeOptions {
  /// Error to aim at; default: the mean of all cells, so that the number of cells stays about the
  /// same and errors become more even.
  std::optional<Length> tolerance;
  /// Distances change with this power of the error; 0.5 corrects it at once.
  std::optional<double> feedback;

  OptionList declare();
};

struct SizeResult {
  SizeField size;
  Report report;
};

/// Wanted distances of lines, from those that were used and the errors that came of it.
///
/// Beyond [MK04], whose distances come from curvature alone. The error of a cell grows with the
/// square of its size, so where it is k times what is aimed at the distances shrink by k^feedback;
/// of the two directions the one along which the surface bends away from the cell more shrinks
/// more. Errors are averaged over neighbouring cells first: what a single cell is off by is mostly
/// chance of where lines lie, and will be elsewhere the next time.
///
/// Deterministic for any number of threads.
/// \param lines    what `quads` was made from: the distances used
/// \param density  where vertices are wanted more densely errors count as much more; may be nullptr
/// \pre all belong to `mesh`
SizeResult size_from_errors(const TriMesh& mesh, const PrincipalField& field, const LineSet& lines,
                            const QuadMesh& quads, const DensityField* density,
                            const SizeOptions& options, Observer& observer);

}  // namespace strake
