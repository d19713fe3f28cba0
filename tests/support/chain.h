#pragma once

#include "common/core/observer.h"
#include "stages/import/import.h"
#include "stages/mesh/mesh.h"
#include "stages/smooth/smooth.h"
#include "stages/tensor/tensor.h"
#include "stages/trace/trace.h"

/// The stages one after the other in memory. Whoever includes this links the stages.
namespace strake::support {

/// A surface with its directions: what tracing starts from.
struct Prepared {
  TriMesh mesh;
  PrincipalField field;
};

inline Prepared prepare(const PolyMesh& soup, const TensorOptions& tensor = {},
                        const SmoothOptions& smooth = {}, const ImportOptions& import = {},
                        const GuideLines* guides = nullptr) {
  SilentObserver observer;
  Prepared prepared;
  prepared.mesh = import_mesh(soup, import, observer).mesh;
  const TensorField field = estimate_tensors(prepared.mesh, tensor, observer).field;
  prepared.field = smooth_tensors(prepared.mesh, field, smooth, observer, guides).field;
  return prepared;
}

inline LineSet trace(const Prepared& prepared, const TraceOptions& options = {}) {
  SilentObserver observer;
  return trace_lines(prepared.mesh, prepared.field, options, observer).lines;
}

inline QuadMesh mesh(const Prepared& prepared, const LineSet& lines,
                     const MeshOptions& options = {}) {
  SilentObserver observer;
  return mesh_lines(prepared.mesh, lines, options, observer).quads;
}

}  // namespace strake::support
