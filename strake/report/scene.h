#pragma once

#include <nlohmann/json_fwd.hpp>

#include "common/core/attributes.h"
#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/cell_error/cell_error.h"
#include "strake/report/blocks.h"
#include "strake/report/result_edges.h"

/// What the viewer draws, as JSON that refers to blocks. docs/report.md lists the members.
namespace strake::report {

/// Input surfaces with more faces are drawn decimated.
inline constexpr std::size_t kMostFaces = 150000;

/// The input surface, with its colours where it has some, and with curvature, directions,
/// confidence and laid guide lines where there is a field.
/// \param field  of this mesh; nullptr: the members "curvature", "directions", "guides" are left
/// out
nlohmann::ordered_json surface_scene(const TriMesh& mesh, const PrincipalField* field,
                                     std::size_t most_faces, Blocks& blocks);

/// The result, with each face's sides, mean angle to the curvature and largest distance to the
/// surface, and with colours and labels where it has some.
/// \param result  of `quads`
/// \param errors  of `quads` against the input
nlohmann::ordered_json result_scene(const VertexProvenance& provenance, const ResultEdges& result,
                                    const ErrorMap& errors, Blocks& blocks);

/// The labels of faces that tell most parts apart; nullptr where there are none.
const FaceLabels* telling_labels(const std::vector<FaceLabels>& kinds);

inline constexpr double kLineDeviation = 5e-5;
inline constexpr std::size_t kMostLinePoints = 100000;

/// The lines, each thinned out to `kLineDeviation` of the diagonal; more, up to 16 times as much,
/// where more than `most_points` would stay.
nlohmann::ordered_json line_scene(const TriMesh& mesh, const LineSet& lines,
                                  std::size_t most_points, Blocks& blocks);

}  // namespace strake::report
