#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "stages/refine/surface_points.h"

namespace strake {

// Changes of a result whose vertices stay where they are. What is proven to be within a tolerance
// stays so.

/// Pieces that proofs may take of a result that may as well stay as it is (ToleranceProof::limit):
/// several times what any took but of needles that overlap, and a few seconds.
inline std::int64_t most_pieces(const QuadMesh& quads) {
  return 1'000'000 + 30 * std::int64_t{quads.mesh.face_count()};
}

/// Makes faces that cross others anew (refill_crossing.h) where the tolerance allows it.
void refill_within(ToleranceProof& proof, QuadMesh& quads);

/// Makes quads of odd faces near each other (redivide_faces.h), which dividing leaves, where the
/// tolerance allows it and no faces come to cross. Edges along feature and boundary lines stay.
/// \param points      of the input
/// \param may_change  [V] 1: of faces that may; empty: all may
void pair_odd_cells_within(ToleranceProof& proof, const SurfacePoints& points,
                           const std::vector<char>& may_change, QuadMesh& quads);

/// How a result is measured that no tolerance holds for: fewer samples than measuring it takes do
/// to compare, and to find its worst places.
inline constexpr CellSampling kCompared = {.rows = 3, .input_step = 0.4};

/// As pair_odd_cells_within where no tolerance holds: quads come no farther from the surface than
/// the faces were that they take the place of, or than twice the root mean square.
void pair_odd_cells_as_near(const std::shared_ptr<const InputSurface>& input,
                            const SurfacePoints& points, QuadMesh& quads);

/// Makes triangles of the cells that others could cut otherwise (ToleranceProof::cells_in_doubt):
/// those by which it was proven. A cell stays where an edge of theirs would be double.
void cut_cells_in_doubt(ToleranceProof& proof, QuadMesh& quads);

/// Ends changes of a result: holds it to the topology that it had, lets faces begin at fans
/// (face_shape.h), and carries attributes over.
/// \param what  the result, in messages
void end_changes(const TriMesh& mesh, const PolyMesh& before, const std::string& what,
                 QuadMesh& quads);

}  // namespace strake
