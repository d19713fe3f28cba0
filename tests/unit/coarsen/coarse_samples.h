#pragma once

#include "common/core/tri_mesh.h"
#include "common/geometry/samples/samples.h"

namespace strake::coarsen_test {

/// A sample as the import stage gives it.
TriMesh sample(SampleKind kind, std::int64_t faces);

/// Its coarser mesh.
TriMesh coarsened(const TriMesh& mesh, std::int64_t vertices);

/// Vertex of the mesh that a vertex of the coarser one is, by a wedge of that.
inline Index parent_vertex(const TriMesh& mesh, const TriMesh& coarse, Index coarse_wedge) {
  return mesh.wedge_vertex[coarse.parent_wedge[coarse_wedge]];
}

}  // namespace strake::coarsen_test
