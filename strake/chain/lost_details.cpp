#include "strake/chain/lost_details.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/mesh_measures.h"
#include "strake/chain/counted.h"

namespace strake {
namespace {

constexpr int kMostAttempts = 2;
/// Faces of a result, from which on there are none, and share of them that crosses, from which on
/// lines are too coarse all over.
constexpr Index kMostFaces = 10000;
constexpr double kCrossAllOver = 0.02;
/// Distance from the surface, in mean lengths of cells, from which on a detail is lost. A first
/// look takes few samples: none is where less than this share of that distance is found with those.
constexpr double kLost = 0.3;
constexpr double kFarFromLost = 0.5;
constexpr CellSampling kFirstLook = {.rows = 2, .input_step = 1};
/// Share of the largest distance from which on a place is looked at.
constexpr double kAmongTheWorst = 0.5;
/// Share of the largest distance that is less, and of the root mean square that is hardly more.
constexpr double kLess = 0.8;
constexpr double kHardlyFarther = 1.05;

/// How far a result is off the surface.
struct Distance {
  double rms = 0;
  double largest = 0;
  std::vector<Vec3> lost;  ///< middles of cells beside lost details, relative to the mesh's origin
};

Vec3 middle_of(const PolyMesh& mesh, Index face) {
  Vec3 sum = Vec3::Zero();
  for (const Index v : mesh.face(face)) sum += mesh.positions[v];
  return sum / static_cast<double>(mesh.face(face).size());
}

Distance distance_of(const Session& session) {
  const auto& mesh = session.get<TriMesh>("mesh");
  const auto& result = session.get<QuadMesh>(result_port(session));
  const ComparedSurfaces surfaces(mesh, result);
  const double cell = std::sqrt(surface_area(mesh) / result.mesh.face_count());
  const ErrorMap first = measure_cells(surfaces, kFirstLook);
  if (first.largest < kFarFromLost * kLost * cell) return {first.rms, first.largest, {}};
  const ErrorMap map = measure_cells(surfaces);
  Distance distance{map.rms, map.largest, {}};
  if (map.largest <= kLost * cell) return distance;
  const double far = std::max(kLost * cell, kAmongTheWorst * map.largest);
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    if (map.cells[f].largest < far) continue;
    distance.lost.push_back(middle_of(result.mesh, f) - mesh.origin);
  }
  return distance;
}

bool is_better(const Attempt& next, const Distance& distance, const Attempt& best,
               const Distance& before) {
  return !next.misses_goal && next.places.size() <= best.places.size() &&
         distance.largest < kLess * before.largest && distance.rms < kHardlyFarther * before.rms;
}

}  // namespace

Attempt regain_details(const Attempt& first, const Again& again,
                       const std::function<void(Attempt&)>& keep) {
  Attempt best = first;
  Attempt last = first;
  const Index faces = first.done.get<QuadMesh>(result_port(first.done)).mesh.face_count();
  const double crossing = static_cast<double>(first.places.size()) / faces;
  if (faces > kMostFaces || crossing > kCrossAllOver) return best;
  Distance least = distance_of(first.done);
  Distance distance = least;
  bool is_last_best = true;
  for (int i = 0; i < kMostAttempts && !distance.lost.empty(); ++i) {
    Session session = last.done;
    session.say(fmt::format("a place is {:.2g} % of the diagonal off; tracing closer lines there",
                            100 * distance.largest / session.get<TriMesh>("mesh").diagonal));
    try {
      last = again(std::move(session), distance.lost);
    } catch (const AlgorithmError&) {
      is_last_best = false;
      break;
    }
    distance = distance_of(last.done);
    is_last_best = is_better(last, distance, best, least);
    if (distance.largest >= least.largest) break;
    if (!is_last_best) continue;
    best = last;
    least = distance;
  }
  if (!is_last_best) keep(best);
  return best;
}

}  // namespace strake
