#pragma once

#include <limits>
#include <utility>
#include <vector>

#include "common/core/fields.h"
#include "common/core/tri_mesh.h"
#include "stages/trace/arm_bonds.h"

namespace strake {

/// Wanted distances between neighbouring lines at every wedge, model units.
struct Spacing {
  std::vector<double> along;   ///< [W] measured along `field.cross`: between lines across it
  std::vector<double> across;  ///< [W] measured across `field.cross`: between lines along it
};

/// Bounds on the spacing, model units.
struct SpacingLimits {
  double smallest = 0;
  double largest = 0;                                    ///< before the scale
  double cap = std::numeric_limits<double>::infinity();  ///< whatever the scale
  double gradation = 0.25;  ///< largest change of spacing per unit of distance on the surface
  double aspect_ratio = 6;  ///< largest ratio of the two spacings of a point
  double scale = 1;         ///< factor on what the tolerance gives
};

/// Distance of lines that keeps a surface of curvature k within the tolerance ([A03], [MK04]
/// section 3): 2 sqrt(tolerance (2 / |k| - tolerance)), with |k| <= 1 / tolerance.
double spacing_for_curvature(double k, double tolerance, double largest);

/// Vertices to expect: the integral of dA / (along * across). \param areas [W]
double predicted_vertices(const std::vector<double>& areas, const Spacing& spacing);

/// Computes line distances for one surface and field; keeps what does not depend on the tolerance.
class SpacingModel {
 public:
  /// \param size  distances to take instead of those that curvature gives; kept by reference
  SpacingModel(const TriMesh& mesh, const PrincipalField& field, const SizeField* size = nullptr);

  /// Keeps the spacing along some half-edges, on both sides, below a length (model units).
  void bound_along(const std::vector<Index>& halfedges, double length);

  /// Wants so many times the vertices per area. \param density  [W] positive
  void multiply_density(const std::vector<double>& density);

  /// Graded spacings for a tolerance (model units). The normal curvature along each arm of the
  /// cross counts, so that nothing depends on which arm is called minimum. Of a size field, which
  /// knows no tolerance, `tolerance` is the square of a factor on its distances.
  [[nodiscard]] Spacing for_tolerance(double tolerance, const SpacingLimits& limits) const;

  /// The tolerance whose graded spacings predict `count` vertices, within 2 % where there is one,
  /// and these spacings.
  [[nodiscard]] std::pair<double, Spacing> for_count(double count,
                                                     const SpacingLimits& limits) const;

  /// Brings graded spacings nearer to those that lines keep by themselves (see line_flow.h), for as
  /// many vertices.
  void follow_lines(double cells, const SpacingLimits& limits, Spacing& spacing) const;

  [[nodiscard]] const std::vector<double>& areas() const { return areas_; }

 private:
  [[nodiscard]] Spacing ungraded(double tolerance, const SpacingLimits& limits) const;
  void apply_bounds(const SpacingLimits& limits, Spacing& spacing) const;

  const TriMesh& mesh_;
  const PrincipalField& field_;
  const SizeField* size_;
  std::vector<std::pair<Index, double>> bounds_;  ///< keys and the largest value each may have
  std::vector<double> shrink_;                    ///< [W] factor on distances; empty: 1
  std::vector<double> areas_;                     ///< [W]
  std::vector<double> curvature_along_;           ///< [W] |normal curvature| along the cross
  std::vector<double> curvature_across_;          ///< [W]
  ArmBonds bonds_;
};

}  // namespace strake
