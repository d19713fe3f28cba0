#include "stages/refine/division.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "stages/refine/division_faults.h"

namespace strake {
namespace {

constexpr const char* kFinishing = "finishing cells";
/// Rounds in which the cell nearest to a place of the input is divided. What is left after that is
/// mostly nearest to a cell that does not lie over it.
constexpr std::int64_t kRoundsInSpace = 3;
/// Rounds after which vertices are moved to the places that are left, where dividing did not help.
constexpr std::int64_t kRoundsOfDividing = 6;
/// Rounds that may leave more places than one before. What is reached at all is reached with fewer
/// from round to round.
constexpr std::int64_t kRoundsInVain = 4;
/// Times that cells are left out because of what dividing them would do.
constexpr int kMostRetreats = 8;

/// Adds to cells, ascending, those that faces would come to cross if only these were divided: a
/// sheet beside, whose cells are off by more than it is away.
void add_crossed(Refinement& refinement, const ComparedSurfaces& surfaces, double tolerance,
                 std::vector<Target>& targets) {
  if (targets.empty()) return;
  const QuadMesh before = refinement.quads();
  const std::vector<std::uint8_t> known = vertices_of_faults(before.mesh, {});
  refinement.divide(surfaces, targets, tolerance);
  const std::vector<std::uint8_t> faulty = vertices_of_faults(refinement.quads().mesh, known);
  refinement.take(before);
  std::vector<char> is_target(static_cast<std::size_t>(before.mesh.face_count()), 0);
  for (const Target& target : targets) is_target[target.face] = 1;
  for (Index f = 0; f < before.mesh.face_count(); ++f) {
    if (is_target[f] != 0 || !has_any(before.mesh.face(f), faulty)) continue;
    targets.push_back({f, tolerance});
  }
  std::ranges::sort(targets, {}, &Target::face);
}

}  // namespace

bool divide_without_faults(Refinement& refinement, const ComparedSurfaces& surfaces,
                           std::vector<Target> targets, std::size_t wanted, double tolerance) {
  const QuadMesh before = refinement.quads();
  const std::vector<std::uint8_t> known = vertices_of_faults(before.mesh, {});
  for (int i = 0; i < kMostRetreats && !targets.empty(); ++i) {
    const auto last =
        targets.begin() + static_cast<std::ptrdiff_t>(std::min(wanted, targets.size()));
    refinement.divide(surfaces, {targets.begin(), last}, tolerance);
    const std::vector<std::uint8_t> faulty = vertices_of_faults(refinement.quads().mesh, known);
    if (std::ranges::find(faulty, 1) == faulty.end()) return true;
    refinement.take(before);
    const auto is_to_blame = [&](const Target& t) {
      return has_any(before.mesh.face(t.face), faulty);
    };
    targets.erase(std::remove_if(targets.begin(), last, is_to_blame), last);
  }
  return false;
}

Divided divide_until_within(ToleranceProof& proof, Refinement& refinement,
                            const DivisionOptions& options, Observer& observer) {
  const TriMesh& mesh = proof.input()->mesh;
  std::size_t last = std::numeric_limits<std::size_t>::max();  // places before the last division
  std::vector<Excess> fewest;  // where dividing came nearest, of all rounds
  std::int64_t fewest_round = 0;
  QuadMesh best;  // the result then
  bool is_stuck = false;
  for (std::int64_t round = 0;; ++round) {
    observer.report("dividing cells", double(round) / double(options.rounds + 1));
    refinement.drop_turned_ears();
    const ComparedSurfaces surfaces(proof.input(), refinement.quads());
    std::vector<Excess> excess = proof.check(surfaces);
    if (excess.empty()) return {round, {}};
    if (round == 0 || excess.size() < fewest.size()) {
      fewest = excess;
      fewest_round = round;
      if (!options.partly) best = refinement.quads();
    }
    const bool are_too_many = refinement.quads().mesh.vertex_count() > options.most_vertices;
    if (is_stuck || are_too_many || round == options.rounds ||
        round - fewest_round == kRoundsInVain) {
      if (!options.partly) refinement.take(std::move(best));
      return {round, options.partly ? std::move(excess) : std::move(fewest)};
    }
    std::vector<Target> targets =
        large_enough(surfaces, refinement.quads().mesh, excess, proof.tolerance(),
                     cells_beyond(mesh, refinement.quads(), excess, round >= kRoundsInSpace));
    if (options.without_faults) {
      add_crossed(refinement, surfaces, proof.tolerance(), targets);
      is_stuck =
          !divide_without_faults(refinement, surfaces, targets, targets.size(), proof.tolerance());
    } else if (targets.empty() || (round >= kRoundsOfDividing && excess.size() >= last)) {
      refinement.reach(excess);
      last = std::numeric_limits<std::size_t>::max();
    } else {
      last = excess.size();
      refinement.divide(surfaces, targets, proof.tolerance());
    }
  }
}

bool inlay_left(ToleranceProof& proof, Refinement& refinement, const std::vector<Excess>& left,
                Observer& observer, const InlayLimits& limits) {
  proof.report_to(observer, kFinishing);
  if (left.empty()) return true;
  QuadMesh inlaid = refinement.quads();
  if (!inlay_beyond(proof, left, refinement.crossing(), inlaid, limits)) return false;
  refinement.take(std::move(inlaid));
  return true;
}

}  // namespace strake
