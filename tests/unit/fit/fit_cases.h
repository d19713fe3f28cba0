#pragma once

#include <cstdint>
#include <utility>

#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/fit.h"
#include "tests/support/chain.h"

/// Results on surfaces for the tests of fitting.
namespace strake::fit_cases {

/// A polygon mesh as a result, each vertex put on the nearest point of the mesh.
inline QuadMesh placed_on(const TriMesh& mesh, PolyMesh result) {
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  QuadMesh quads;
  for (Vec3& p : result.positions) {
    const ClosestPoint nearest = surface.closest(p);
    p = surface.point(nearest);
    quads.provenance.face.push_back(nearest.triangle);
    quads.provenance.barycentric.push_back(nearest.barycentric);
    quads.provenance.lines.push_back({kNone, kNone});
  }
  quads.mesh = std::move(result);
  return quads;
}

/// Fitted without a field.
inline QuadMesh fitted(const TriMesh& mesh, const QuadMesh& quads, std::int64_t rounds = 6) {
  SilentObserver observer;
  FitOptions options;
  options.rounds = rounds;
  return fit_vertices(mesh, nullptr, quads, options, observer).quads;
}

inline QuadMesh fitted_with_field(const support::Prepared& surface, const QuadMesh& quads) {
  SilentObserver observer;
  return fit_vertices(surface.mesh, &surface.field, quads, {}, observer).quads;
}

}  // namespace strake::fit_cases
