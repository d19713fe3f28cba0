#include "strake/chain/result_faults.h"

#include <algorithm>
#include <cmath>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"

namespace strake {
namespace {

/// Vertices or faces off a wanted count that are none: no lines may make a number nearer to it.
constexpr std::int64_t kNextTo = 2;

CellSampling sampling_of(const PolyMesh& result, double samples) {
  const double root = std::sqrt(samples / result.face_count());
  return {.rows = static_cast<int>(std::clamp(root, 3.0, 20.0)),
          .input_step = 1 / std::clamp(root, 3.0, 20.0)};
}

}  // namespace

ResultFaults faults_of(const Session& session, Counted counted, std::int64_t wanted,
                       CrossingPlaces& crossing, double samples) {
  const auto& mesh = session.get<TriMesh>("mesh");
  const char* port = result_port(session);
  const auto& result = session.get<QuadMesh>(port);
  const std::int64_t count = count_of(session, port, counted);
  const double share = static_cast<double>(count) / static_cast<double>(wanted);
  const double cell = std::sqrt(surface_area(mesh) / result.mesh.vertex_count() * share);
  const ErrorMap map =
      measure_cells(ComparedSurfaces(mesh, result), sampling_of(result.mesh, samples));
  const auto faces = static_cast<double>(result.mesh.face_count());
  return {.distance = share * map.rms / cell,
          .largest = map.largest / cell,
          .crossing = static_cast<double>(crossing.of(result.mesh).size()) / faces,
          .missing = std::abs(count - wanted) <= kNextTo ? 0 : std::abs(share - 1),
          .odd = 1 - static_cast<double>(analyse(result.mesh).quads) / faces,
          .thin = thin_face_share(result.mesh)};
}

}  // namespace strake
