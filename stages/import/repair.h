#pragma once

#include <optional>

#include "common/core/observer.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"
#include "stages/import/fill_holes.h"
#include "stages/import/import.h"
#include "stages/import/openings.h"
#include "stages/import/sew.h"
#include "stages/import/soup.h"

namespace strake::import {

/// The triangles of a mesh once they are a manifold, and what that took.
struct Repaired {
  Soup triangles;
  TriMesh frame;  ///< origin and diagonal alone
  Repairs repairs;
  double removed_percent = 0;        ///< of the surface
  NearBorders near;                  ///< that stay open
  std::optional<FilledHoles> holes;  ///< where that was asked for
  Openness openness;                 ///< before faces were taken out
};

/// Makes a manifold of polygons, and fills its holes where that is asked for.
/// \throw InputError where repairs are forbidden or would take too much away, or nothing is left
Repaired repair(const PolyMesh& soup, const ImportOptions& options, Observer& observer);

/// Tells what was repaired, and what stays open.
/// \param after           how open the surface is now
/// \param boundary_loops  of it
void report_repairs(const Repaired& repaired, const Openness& after, Index boundary_loops,
                    Report& report);

}  // namespace strake::import
