#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "stages/evaluate/alignment.h"

namespace strake::report {

/// A result in the frame of its input, with its edges and how they lie to the curvature.
struct ResultEdges {
  PolyMesh mesh;
  PolyEdges edges;
  std::vector<evaluation::EdgeAngles> angles;  ///< [E]; empty without a field

  /// [F] mean angle of each face's edges to the principal directions, 0 to 45 degrees, by length;
  /// negative where none of them is judged. Empty without a field.
  [[nodiscard]] std::vector<double> face_angles() const;
};

/// \param field  of `mesh`; nullptr: no angles
ResultEdges measure_edges(const TriMesh& mesh, const PrincipalField* field, const QuadMesh& quads);

}  // namespace strake::report
