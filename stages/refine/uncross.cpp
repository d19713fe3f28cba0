#include "stages/refine/uncross.h"

#include <algorithm>
#include <memory>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "stages/refine/changes_within.h"
#include "stages/refine/inlays.h"

namespace strake {
namespace {

/// Few samples do to tell how far a result is from the surface.
constexpr CellSampling kSampling = {.rows = 2, .input_step = 1};
/// Distance by which inlays are thinned out, in root mean squares of the result's.
constexpr double kThinnedBy = 2;

}  // namespace

Index uncross(const TriMesh& mesh, const SurfacePoints& points, CrossingPlaces& crossing,
              QuadMesh& quads) {
  const std::size_t before = crossing.faces_of(quads.mesh).size();
  if (before == 0) return 0;
  const auto input = std::make_shared<const InputSurface>(mesh);
  const ComparedSurfaces surfaces(input, quads);
  const ErrorMap errors = measure_cells(surfaces, kSampling);
  if (!(errors.rms > 0)) return 0;
  ToleranceProof proof(input, errors.largest);
  proof.assume(surfaces);
  QuadMesh inlaid = quads;
  const std::vector<char> is_new =
      inlay_crossing(proof, crossing, std::min(proof.tolerance(), kThinnedBy * errors.rms), inlaid);
  if (is_new.empty()) return 0;
  pair_odd_cells_within(proof, points, is_new, inlaid);
  const std::size_t after = crossing.faces_of(inlaid.mesh).size();
  if (after >= before) return 0;
  quads = std::move(inlaid);
  return static_cast<Index>(before - after);
}

}  // namespace strake
