#pragma once

#include "common/core/fields.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct FitOptions {
  std::int64_t rounds = 6;
  bool keep_flats = false;  ///< leave vertices inside flats where lines meet

  OptionList declare();
};

struct FitResult {
  QuadMesh quads;
  Report report;
};

/// Moves vertices to where the faces between them lie nearest to the surface, and edges run along
/// the field.
///
/// Beyond [MK04], whose vertices stay on the surface where lines cross. Gauss-Newton steps on a sum
/// of squares: area times the squared distance of result and surface, both ways (deviation.h), and
/// the turn of edges against the field and of lines in their vertices (flow_lines.h), a radian
/// worth as much as twelve times the present RMS distance, or 0.7 % of a cell. Vertices on
/// feature and boundary lines slide along them, corners stay (vertex_places.h). A step is taken
/// only where the sum falls, and leaves out vertices around which faces would become concave, thin,
/// turned over, or cross others (face_guard.h). Then vertices inside flats, which nothing holds,
/// are spread evenly (even_flats.h). At the end faces that cross others are moved apart, divided,
/// or made anew with those around (move_apart.h, divide_crossing.h, refill_crossing.h).
/// \param field  nullptr: lines of edges only keep straight and even
/// \pre `quads` was made from `mesh`, and so was `field`
/// \return the same faces but for those; provenance with the new feet; the same for any number of
///         threads
/// Cost O(faces of the result * log faces of the mesh) per round.
FitResult fit_vertices(const TriMesh& mesh, const PrincipalField* field, const QuadMesh& quads,
                       const FitOptions& options, Observer& observer);

}  // namespace strake
