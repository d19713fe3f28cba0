#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Judges how far results follow a density, beside one that was made without it.
///
/// With n the vertices per area of the latter, those wanted go as n times the density. Compared
/// are means over all vertices of the logarithm of the density where they lie.
class DensityMatch {
 public:
  /// \param mesh   referred to
  /// \param plain  made without the density
  /// \throw PreconditionError where the density is of another mesh
  DensityMatch(const TriMesh& mesh, const DensityField& density, const QuadMesh& plain);

  /// Share of the way from the result without the density to what is wanted: 1 is exact, more is
  /// too much. 1 too where the density is the same everywhere.
  [[nodiscard]] double reached(const QuadMesh& quads) const;

 private:
  [[nodiscard]] double density_at(const QuadMesh& quads, Index vertex) const;

  const TriMesh& mesh_;
  std::vector<double> density_;  ///< [W]
  double plain_mean_ = 0;
  double wanted_mean_ = 0;
};

}  // namespace strake
