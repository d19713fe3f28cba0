#include "strake/chain/result_faults.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/geometry/angles.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/mesh_measures.h"
#include "common/geometry/poly_topology/poly_topology.h"

namespace strake {
namespace {

CellSampling sampling_of(const PolyMesh& result, double samples) {
  const double root = std::sqrt(samples / result.face_count());
  return {.rows = static_cast<int>(std::clamp(root, 3.0, 20.0)),
          .input_step = 1 / std::clamp(root, 3.0, 20.0)};
}

bool is_thin(const PolyMesh& mesh, Index f) {
  constexpr double kThin = 10 * kDegree;
  const std::span<const Index> face = mesh.face(f);
  const std::size_t n = face.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3& p = mesh.positions[face[i]];
    const Vec3 before = mesh.positions[face[(i + n - 1) % n]] - p;
    if (angle_between(before, mesh.positions[face[(i + 1) % n]] - p) < kThin) return true;
  }
  return false;
}

double thin_share(const PolyMesh& mesh) {
  Index thin = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) thin += is_thin(mesh, f) ? 1 : 0;
  return double(thin) / mesh.face_count();
}

}  // namespace

ResultFaults faults_of(const Session& session, Counted counted, std::int64_t wanted,
                       CrossingPlaces& crossing, double samples) {
  const auto& mesh = session.get<TriMesh>("mesh");
  const char* port = result_port(session);
  const auto& result = session.get<QuadMesh>(port);
  const double share =
      static_cast<double>(count_of(session, port, counted)) / static_cast<double>(wanted);
  const double cell = std::sqrt(surface_area(mesh) / result.mesh.vertex_count() * share);
  const ErrorMap map =
      measure_cells(ComparedSurfaces(mesh, result), sampling_of(result.mesh, samples));
  const auto faces = static_cast<double>(result.mesh.face_count());
  return {.distance = share * map.rms / cell,
          .largest = map.largest / cell,
          .crossing = static_cast<double>(crossing.of(result.mesh).size()) / faces,
          .missing = std::abs(share - 1),
          .odd = 1 - static_cast<double>(analyse(result.mesh).quads) / faces,
          .thin = thin_share(result.mesh)};
}

}  // namespace strake
