#include "stages/refine/cells_beyond.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <optional>

#include "common/geometry/nearest_on_surface.h"
#include "common/geometry/poly_topology/vertex_faces.h"

namespace strake {
namespace {

/// Size, in tolerances, of cells that are too small to be divided for places of the input: what is
/// farther than one tolerance from the middle of an edge of up to two is outside the ball over it,
/// so a vertex there hardly comes nearer.
constexpr double kTooSmall = 1.5;

}  // namespace

std::vector<Target> cells_beyond(const TriMesh& mesh, const QuadMesh& quads,
                                 const std::vector<Excess>& excess, bool on_surface) {
  if (excess.empty()) return {};
  std::vector<double> distance(static_cast<std::size_t>(quads.mesh.face_count()), 0);
  const auto note = [&](Index cell, double d) { distance[cell] = std::max(distance[cell], d); };
  std::optional<VertexFaces> around;
  std::vector<Index> nearest(on_surface ? excess.size() : 0, kNone);  // vertices, on the surface
  if (on_surface) {
    const NearestOnSurface search(mesh, quads);
    tbb::parallel_for(std::size_t{0}, excess.size(), [&](std::size_t i) {
      const Excess& e = excess[i];
      if (e.input_face != kNone) nearest[i] = search.vertex(e.input_face, e.place);
    });
    around.emplace(quads.mesh);
  }
  for (std::size_t i = 0; i < excess.size(); ++i) {
    const Excess& e = excess[i];
    if (!on_surface || e.input_face == kNone) {
      note(e.cell, e.distance);
    } else if (nearest[i] != kNone) {
      for (const Index f : around->faces(nearest[i])) note(f, e.distance);
    }
  }
  std::vector<Target> targets;
  for (std::size_t f = 0; f < distance.size(); ++f) {
    if (distance[f] > 0) targets.push_back({static_cast<Index>(f), distance[f]});
  }
  return targets;
}

std::vector<Target> large_enough(const ComparedSurfaces& surfaces, const PolyMesh& mesh,
                                 const std::vector<Excess>& excess, double tolerance,
                                 std::vector<Target> targets) {
  std::vector<char> is_beyond(static_cast<std::size_t>(mesh.face_count()), 0);
  for (const Excess& e : excess) {
    if (e.input_face == kNone) is_beyond[e.cell] = 1;
  }
  std::erase_if(targets, [&](const Target& target) {
    Eigen::AlignedBox3d box;
    for (const Index v : mesh.face(target.face)) box.extend(surfaces.positions()[v]);
    return is_beyond[target.face] == 0 && box.diagonal().norm() < kTooSmall * tolerance;
  });
  return targets;
}

std::vector<Target> cells_by_distance(const ErrorMap& errors) {
  std::vector<Target> targets;
  for (std::size_t f = 0; f < errors.cells.size(); ++f) {
    targets.push_back({static_cast<Index>(f), errors.cells[f].largest});
  }
  std::stable_sort(targets.begin(), targets.end(),
                   [](const Target& a, const Target& b) { return a.distance > b.distance; });
  return targets;
}

}  // namespace strake
