#include "strake/chain/density_match.h"

#include <cmath>

#include "common/geometry/density.h"

namespace strake {

DensityMatch::DensityMatch(const TriMesh& mesh, const DensityField& density, const QuadMesh& plain)
    : mesh_(mesh), density_(density_at_wedges(mesh, density)) {
  double sum = 0;
  double weights = 0;
  for (Index v = 0; v < plain.mesh.vertex_count(); ++v) {
    const double here = density_at(plain, v);
    plain_mean_ += std::log(here) / plain.mesh.vertex_count();
    sum += here * std::log(here);
    weights += here;
  }
  wanted_mean_ = sum / weights;
}

double DensityMatch::reached(const QuadMesh& quads) const {
  constexpr double kSame = 1e-9;
  if (std::abs(wanted_mean_ - plain_mean_) < kSame) return 1;
  double mean = 0;
  for (Index v = 0; v < quads.mesh.vertex_count(); ++v) {
    mean += std::log(density_at(quads, v)) / quads.mesh.vertex_count();
  }
  return (mean - plain_mean_) / (wanted_mean_ - plain_mean_);
}

double DensityMatch::density_at(const QuadMesh& quads, Index vertex) const {
  const auto& wedges = mesh_.face_wedges[quads.provenance.face[vertex]];
  const auto& barycentric = quads.provenance.barycentric[vertex];
  double density = 0;
  for (int i = 0; i < 3; ++i) density += barycentric[i] * density_[wedges[i]];
  return density;
}

}  // namespace strake
