#pragma once

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/samples/samples.h"

namespace strake::coarsen_test {

/// A sample as the import stage gives it.
TriMesh sample(SampleKind kind, std::int64_t faces);

/// Its coarser mesh.
TriMesh coarsened(const TriMesh& mesh, std::int64_t vertices);

/// The field at the vertices of a coarser mesh, estimated over the mesh.
PrincipalField coarse_field(const TriMesh& mesh, const TriMesh& coarse);

/// The unit sphere, and inside it another one that faces the other way.
PolyMesh thin_shell(double thickness);

/// Vertex of the mesh that a vertex of the coarser one is, by a wedge of that.
inline Index parent_vertex(const TriMesh& mesh, const TriMesh& coarse, Index coarse_wedge) {
  return mesh.wedge_vertex[coarse.parent_wedge[coarse_wedge]];
}

}  // namespace strake::coarsen_test
