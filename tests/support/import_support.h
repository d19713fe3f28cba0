#pragma once

#include "common/core/observer.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "stages/import/import.h"

namespace strake::support {

/// Runs a polygon mesh through the import stage: feature graph, vertices in the stage's own order.
inline TriMesh import_tri_mesh(const PolyMesh& mesh, double feature_angle_deg = 40) {
  ImportOptions options;
  options.feature_angle_deg = feature_angle_deg;
  SilentObserver observer;
  return import_mesh(mesh, options, observer).mesh;
}

}  // namespace strake::support
