#pragma once

#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// Wanted distances between neighbouring lines at every wedge, model units.
struct Spacing {
  std::vector<double> along;   ///< [W] measured along `field.cross`: between lines across it
  std::vector<double> across;  ///< [W] measured across `field.cross`: between lines along it
};

/// Bounds on the spacing, model units.
struct SpacingLimits {
  double smallest = 0;
  double largest = 0;
  double gradation = 0.25;   ///< largest change of spacing per unit of distance on the surface
  double aspect_ratio = 6;   ///< largest ratio of the two spacings of a point
};

/// Distance of lines that keeps a surface of curvature k within the tolerance ([A03], [MK04]
/// section 3): 2 sqrt(tolerance (2 / |k| - tolerance)), with |k| <= 1 / tolerance.
double spacing_for_curvature(double k, double tolerance, double largest);

/// Graded spacings for a tolerance. The normal curvature along each arm of the cross counts, so
/// that nothing depends on which arm is called minimum.
Spacing spacing_for_tolerance(const TriMesh& mesh, const PrincipalField& field, double tolerance,
                              const SpacingLimits& limits);

/// Vertices to expect: the integral of dA / (along * across).
double predicted_vertices(const std::vector<double>& areas, const Spacing& spacing);

/// The tolerance whose graded spacings predict `count` vertices; found by bisection on its logarithm.
double tolerance_for_count(const TriMesh& mesh, const PrincipalField& field, double count,
                           const SpacingLimits& limits);

}  // namespace strake
