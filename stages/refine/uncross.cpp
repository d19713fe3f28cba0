#include "stages/refine/uncross.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "stages/refine/changes_within.h"
#include "stages/refine/inlays.h"
#include "stages/refine/surface_points.h"

namespace strake {
namespace {

constexpr const char* kPhase = "replacing faces that cross";
/// Few samples do to tell how far a result is from the surface.
constexpr CellSampling kSampling = {.rows = 2, .input_step = 1};
/// Distance by which inlays are thinned out at first, in root mean squares of the result's.
constexpr double kThinnedBy = 2;
/// Least tolerance that is proven, of the diagonal: what is exact but for rounding would be cut to
/// pieces without end. The same as that of refining.
constexpr double kLeastTolerance = 1e-6;

/// The result with inlays; as it is where there are none.
/// \throw ProofTooLong
QuadMesh with_inlays(const TriMesh& mesh, const QuadMesh& quads, CrossingPlaces& crossing,
                     Observer& observer) {
  const auto input = std::make_shared<const InputSurface>(mesh);
  const ComparedSurfaces surfaces(input, quads);
  const ErrorMap errors = measure_cells(surfaces, kSampling);
  const double least = kLeastTolerance * mesh.diagonal;
  ToleranceProof proof(input, std::max(errors.largest, least));
  proof.report_to(observer, kPhase);
  proof.assume(surfaces);
  proof.limit(most_pieces(quads));
  QuadMesh inlaid = quads;
  inlaid.mesh.attributes = {};  // carried over anew at the end
  const double thinned_by = std::min(proof.tolerance(), std::max(kThinnedBy * errors.rms, least));
  const std::vector<char> is_of_inlay = inlay_crossing(proof, crossing, thinned_by, inlaid);
  if (is_of_inlay.empty()) return quads;
  pair_odd_cells_within(proof, SurfacePoints(mesh), is_of_inlay, inlaid);
  return inlaid;
}

}  // namespace

UncrossResult uncross_faces(const TriMesh& mesh, const QuadMesh& quads, Observer& observer) {
  UncrossResult result{quads, {}};
  CrossingPlaces crossing(mesh);
  const std::size_t before = crossing.faces_of(quads.mesh).size();
  std::size_t after = before;
  if (before > 0) {
    observer.report(kPhase, 0);
    try {
      QuadMesh inlaid = with_inlays(mesh, quads, crossing, observer);
      after = crossing.faces_of(inlaid.mesh).size();
      if (after < before) result.quads = std::move(inlaid);
    } catch (const ProofTooLong&) {  // the result stays as it is
    }
  }
  if (after < before) {
    end_changes(mesh, quads.mesh, "the result with faces of the input", result.quads);
  }
  result.report.set("refine.uncrossed_faces",
                    static_cast<std::int64_t>(before - std::min(before, after)));
  result.report.set(
      "refine.inlaid_vertices",
      static_cast<std::int64_t>(result.quads.mesh.vertex_count() - quads.mesh.vertex_count()));
  return result;
}

}  // namespace strake
