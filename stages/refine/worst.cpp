#include "stages/refine/worst.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "stages/refine/changes_within.h"
#include "stages/refine/division.h"
#include "stages/refine/refinement.h"

namespace strake {
namespace {

/// Shares of the largest distance that are tried: the first one, then the second, or the third
/// where that is too much.
constexpr double kHalf = 0.5;
constexpr double kLess = 0.35;
constexpr double kMore = 0.7;
/// Largest distance, in root mean squares, up to which a result is even: cells all over would have
/// to be divided.
constexpr double kEven = 4;
/// Least distance that is worth it, of the diagonal: what is exact but for rounding stays.
constexpr double kLeastTolerance = 1e-6;
/// Shares of all faces by which there may be more that are no quads, or thin.
constexpr double kMoreOdd = 0.005;
constexpr double kMoreThin = 0.002;
/// What grows further takes too many vertices; and where there are many faults, they have stayed
/// for good reason.
constexpr InlayLimits kSmallInlays = {.cells = 200, .rounds = 5, .places = 200};
/// Corners that faces may come to have, or as many as one has already.
constexpr std::int64_t kQuad = 4;

struct Quality {
  double rms = 0;      ///< distance, model units
  double largest = 0;  ///< the same
  std::size_t crossing = 0;
  Index concave = 0;
  double odd = 0;   ///< share of the faces
  double thin = 0;  ///< likewise
};

struct Found {
  QuadMesh quads;
  Quality quality;
};

bool has_more_faults(const Quality& other, const Quality& first) {
  return other.crossing > first.crossing || other.concave > first.concave;
}

bool is_better(const Quality& other, const Quality& first) {
  return other.largest < first.largest && other.rms <= first.rms &&
         !has_more_faults(other, first) && other.odd <= first.odd + kMoreOdd &&
         other.thin <= first.thin + kMoreThin;
}

/// Cells that are farther off than the tolerance.
std::int64_t count_beyond(const ErrorMap& errors, double tolerance) {
  return std::ranges::count_if(errors.cells,
                               [&](const CellError& cell) { return cell.largest > tolerance; });
}

/// Results that are nearer to the surface where they are farthest from it.
class NearerResults {
 public:
  NearerResults(const TriMesh& mesh, const QuadMesh& quads, std::int64_t most_vertices,
                Observer& observer)
      : mesh_(mesh),
        quads_(quads),
        most_vertices_(most_vertices),
        observer_(observer),
        input_(std::make_shared<const InputSurface>(mesh)),
        crossing_(mesh) {
    observer.report("looking for the worst places", 0);
    errors_ = measure_.measure(ComparedSurfaces(input_, quads));
    first_ = quality_of(quads, errors_);
    is_stacked_ = crossing_.is_stacked();
  }

  [[nodiscard]] const Quality& first() const { return first_; }
  /// Whether it makes sense to look for any.
  [[nodiscard]] bool may_be() const {
    return !is_stacked_ && most_vertices_ > quads_.mesh.vertex_count() &&
           first_.largest >= kEven * first_.rms;
  }

  /// \param share  of the largest distance that is to be kept
  /// \return nothing where that takes too many vertices or too long, or is no better
  std::optional<Found> within(double share) {
    const double tolerance = share * first_.largest;
    const std::int64_t room = most_vertices_ - quads_.mesh.vertex_count();
    if (tolerance < kLeastTolerance * mesh_.diagonal || count_beyond(errors_, tolerance) > room) {
      return std::nullopt;
    }
    try {
      std::optional<Found> found = refined(tolerance, false);
      if (found && has_more_faults(found->quality, first_)) found = refined(tolerance, true);
      if (found && is_better(found->quality, first_)) return found;
    } catch (const ProofTooLong&) {  // the result stays as it is
    }
    return std::nullopt;
  }

 private:
  Quality quality_of(const QuadMesh& quads, const ErrorMap& errors) {
    const PolyMesh& mesh = quads.mesh;
    const auto faces = static_cast<double>(mesh.face_count());
    Index odd = 0;
    Index concave = 0;
    for (Index f = 0; f < mesh.face_count(); ++f) {
      if (mesh.face(f).size() != 4) ++odd;
      if (is_concave_face(mesh.positions, mesh.face(f))) ++concave;
    }
    return {.rms = errors.rms,
            .largest = errors.largest,
            .crossing = crossing_.meeting(mesh).crossing.size(),
            .concave = concave,
            .odd = odd / faces,
            .thin = thin_face_share(mesh)};
  }

  std::optional<Found> refined(double tolerance, bool without_faults) {
    const ComparedSurfaces surfaces(input_, quads_);
    std::vector<char> is_beyond(errors_.cells.size());
    for (std::size_t f = 0; f < is_beyond.size(); ++f) {
      is_beyond[f] = errors_.cells[f].largest > tolerance ? 1 : 0;
    }
    ToleranceProof proof(input_, tolerance);
    proof.assume(surfaces, is_beyond);
    proof.limit(most_pieces(quads_));
    Refinement refinement(mesh_, quads_, kQuad);
    refinement.put_back(input_->distance, tolerance);
    const Divided divided = divide_until_within(
        proof, refinement, {.without_faults = without_faults, .most_vertices = most_vertices_},
        observer_);
    const auto are_too_many = [&] {
      return refinement.quads().mesh.vertex_count() > most_vertices_;
    };
    if (are_too_many() || !inlay_left(proof, refinement, divided.left, observer_, kSmallInlays)) {
      return std::nullopt;
    }
    refinement.finish(proof, kSmallInlays);
    if (are_too_many()) return std::nullopt;
    Found found{refinement.quads(), {}};
    found.quality =
        quality_of(found.quads, measure_.measure(ComparedSurfaces(input_, found.quads)));
    return found;
  }

  const TriMesh& mesh_;
  const QuadMesh& quads_;
  std::int64_t most_vertices_;
  Observer& observer_;
  std::shared_ptr<const InputSurface> input_;
  CrossingPlaces crossing_;
  CellMeasure measure_{kCompared};
  ErrorMap errors_;
  Quality first_;
  bool is_stacked_ = false;  ///< sheets on top of each other, before anything was done
};

std::optional<Found> nearest(NearerResults& results) {
  std::optional<Found> half = results.within(kHalf);
  if (!half) return results.within(kMore);
  std::optional<Found> less = results.within(kLess);
  return less ? std::move(less) : std::move(half);
}

}  // namespace

WorstResult bring_worst_nearer(const TriMesh& mesh, const QuadMesh& quads,
                               const WorstOptions& options, Observer& observer) {
  const Index given = quads.mesh.vertex_count();
  const auto most = static_cast<std::int64_t>((1 + options.share) * given);
  NearerResults results(mesh, quads, most, observer);
  const Quality& first = results.first();
  std::optional<Found> found;
  if (results.may_be()) found = nearest(results);
  if (found) end_changes(mesh, quads.mesh, "the result with nearer places", found->quads);
  WorstResult result{found ? std::move(found->quads) : quads, {}};
  result.report.set("refine.largest_before", first.largest);
  result.report.set("refine.largest", found ? found->quality.largest : first.largest);
  result.report.set("refine.added_vertices",
                    static_cast<std::int64_t>(result.quads.mesh.vertex_count() - given));
  return result;
}

}  // namespace strake
