#pragma once

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct CoarsenOptions {
  std::int64_t vertices =
      100000;  ///< of the coarser mesh, beside those on feature and boundary lines

  OptionList declare();
};

struct CoarsenResult {
  TriMesh mesh;  ///< knows its parent; without attributes
  Report report;
};

/// A coarser mesh of the same surface, for work whose cost should go by the size of the result and
/// not by that of a finer input.
///
/// Beyond [MK04]. Vertices are collapsed into neighbours where that costs least by quadrics
/// (Garland & Heckbert 1997), many at a time that do not touch each other, so the vertices left are
/// some of the mesh's, at the same places. All on feature and boundary lines stay, with the edges
/// between them. No edge gets much longer than the mean distance of vertices, for fields to mean
/// something between them.
/// \return the same topology; more vertices than wanted where folds do not allow fewer, and the
/// mesh itself where it has no more
/// Cost O(V log V). Deterministic for any thread count.
CoarsenResult coarsen_mesh(const TriMesh& mesh, const CoarsenOptions& options, Observer& observer);

}  // namespace strake
