#include "stages/refine/refine.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/core/place_text.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "stages/refine/cells_beyond.h"
#include "stages/refine/division.h"
#include "stages/refine/refinement.h"

namespace strake {
namespace {

/// Of the tolerance, kept for the rounding of whoever measures again.
constexpr double kMargin = 1e-3;
constexpr std::int64_t kMostSides = 5;
constexpr std::size_t kNamedPlaces = 5;
/// Rounds in which the worst cells are divided up to a count.
constexpr std::int64_t kRoundsOfCount = 4;
/// Share of the faces that cross once the tolerance is reached, from which on cells are divided
/// anew without that: sheets are nearer to each other than cells are off there.
constexpr double kTangledShare = 0.1;
/// Vertices that dividing a cell gives, about.
constexpr double kVerticesPerCell = 1.5;

/// The worst places, for a message. \param tolerance  model units
std::string describe(std::vector<Excess> excess, const TriMesh& mesh, double tolerance) {
  std::stable_sort(excess.begin(), excess.end(),
                   [](const Excess& a, const Excess& b) { return a.distance > b.distance; });
  std::string text;
  std::vector<Vec3> named;
  for (const Excess& e : excess) {
    const auto is_near = [&](const Vec3& p) { return (p - e.place).norm() < tolerance; };
    if (std::any_of(named.begin(), named.end(), is_near)) continue;
    const Vec3 p = e.place + mesh.origin;
    text += fmt::format("{}{:.3g} at {}", named.empty() ? "" : ", ", e.distance,
                        place_text(p, mesh.diagonal));
    named.push_back(e.place);
    if (named.size() == kNamedPlaces) break;
  }
  return text;
}

DivisionOptions division_of(const RefineOptions& options, bool without_faults) {
  return {.rounds = options.rounds, .partly = options.partly, .without_faults = without_faults};
}

/// Where dividing made many faces cross, which is what inlays would replace, divides anew what it
/// can without that, and inlays what is left.
/// \param start  before anything was divided
/// \return the rounds it took; nothing, and the result as it was, where it is no better
std::optional<std::int64_t> divide_untangled(ToleranceProof& proof, Refinement& refinement,
                                             const QuadMesh& start, const RefineOptions& options,
                                             Observer& observer) {
  const auto crossing = [&](const QuadMesh& quads) {
    return refinement.crossing().meeting(quads.mesh).crossing.size();
  };
  const QuadMesh tangled = refinement.quads();
  const std::size_t faults = crossing(tangled);
  if (static_cast<double>(faults) < kTangledShare * tangled.mesh.face_count()) return std::nullopt;
  if (2 * crossing(start) > faults) return std::nullopt;
  refinement.take(start);
  const Divided divided =
      divide_until_within(proof, refinement, division_of(options, true), observer);
  if (inlay_left(proof, refinement, divided.left, observer) &&
      crossing(refinement.quads()) < faults) {
    return divided.rounds;
  }
  refinement.take(tangled);
  return std::nullopt;
}

/// Divides cells until all are within the tolerance, and inlays what is left.
/// \return the rounds it took
std::int64_t refine_to_tolerance(const TriMesh& mesh, Refinement& refinement,
                                 const RefineOptions& options, Observer& observer, Report& report) {
  const double wanted = options.tolerance->resolve(mesh.diagonal);
  ToleranceProof proof(std::make_shared<const InputSurface>(mesh), (1 - kMargin) * wanted);
  refinement.put_back(proof.input()->distance, proof.tolerance());
  const QuadMesh start = refinement.quads();
  Divided divided = divide_until_within(proof, refinement, division_of(options, false), observer);
  report.set("refine.places_beyond", divided.left.size());
  if (options.partly && !divided.left.empty()) return divided.rounds;
  const bool may_inlay = !options.partly && options.rounds > 0;
  std::optional<std::int64_t> rounds;
  if (may_inlay) rounds = divide_untangled(proof, refinement, start, options, observer);
  const bool may_do = may_inlay || divided.left.empty();
  if (!rounds && may_do && inlay_left(proof, refinement, divided.left, observer)) {
    rounds = divided.rounds;
  }
  if (rounds) {
    report.set("refine.places_beyond", std::size_t{0});
    refinement.finish(proof);
    refinement.cut_in_doubt(proof);
    return *rounds;
  }
  std::vector<Vec3> places;
  for (const Excess& e : divided.left) places.push_back(e.place);
  throw ToleranceError(
      fmt::format("the result is farther than {:.6g} from the surface, after {} rounds of "
                  "dividing cells: {}; use a larger tolerance, closer lines or more "
                  "--refine-rounds",
                  wanted, divided.rounds,
                  describe(std::move(divided.left), mesh, proof.tolerance())),
      std::move(places));
}

/// Divides the worst cells until there are enough vertices. \return the rounds it took
std::int64_t refine_to_count(const TriMesh& mesh, Refinement& refinement,
                             const RefineOptions& options, Observer& observer) {
  const auto input = std::make_shared<const InputSurface>(mesh);
  std::int64_t round = 0;
  for (; round < std::min(options.rounds, kRoundsOfCount); ++round) {
    observer.report("dividing cells", double(round) / double(kRoundsOfCount));
    const std::int64_t missing = *options.vertices - refinement.quads().mesh.vertex_count();
    const auto cells = static_cast<double>(missing) / kVerticesPerCell;
    if (cells < 1) break;
    const ComparedSurfaces surfaces(input, refinement.quads());
    divide_without_faults(refinement, surfaces, cells_by_distance(measure_cells(surfaces)),
                          static_cast<std::size_t>(cells), std::numeric_limits<double>::infinity());
  }
  refinement.pair_odd_cells(input);
  return round;
}

}  // namespace

RefineResult refine_cells(const TriMesh& mesh, const QuadMesh& quads, const RefineOptions& options,
                          Observer& observer) {
  if (options.tolerance && options.vertices) {
    throw UsageError("give only one of --refine-tolerance and --refine-vertices");
  }
  Refinement refinement(mesh, quads, options.sides.value_or(kMostSides));
  RefineResult result;
  std::int64_t rounds = 0;
  if (options.tolerance) {
    rounds = refine_to_tolerance(mesh, refinement, options, observer, result.report);
  } else if (options.vertices) {
    rounds = refine_to_count(mesh, refinement, options, observer);
  }
  result.quads = refinement.quads();
  end_changes(mesh, quads.mesh, "the mesh of divided cells", result.quads);
  result.report.set("refine.rounds", rounds);
  result.report.set(
      "refine.added_vertices",
      static_cast<std::int64_t>(result.quads.mesh.vertex_count() - quads.mesh.vertex_count()));
  return result;
}

}  // namespace strake
