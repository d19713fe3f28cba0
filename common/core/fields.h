#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/core/guides.h"
#include "common/core/types.h"

namespace strake {

/// Curvature tensors as estimated, one per wedge of a TriMesh ([MK04] section 2).
struct TensorField {
  std::string mesh_id;
  /// [W] symmetric 3x3 normal-cycle tensor, 1/length, world frame: xx, xy, xz, yy, yz, zz.
  /// The eigenvector of its larger |eigenvalue| is the *minimum* curvature direction.
  /// Positive where the surface is convex (bends away from the normal).
  std::vector<std::array<double, 6>> tensor;
  std::vector<Vec3> normal;  ///< [W] unit, angle-weighted over the wedge's faces
};

/// Principal frames after smoothing, one per wedge, with the confidence that they mean something.
struct PrincipalField {
  std::string mesh_id;
  std::vector<Vec3> normal;   ///< [W] unit
  std::vector<Vec3> t_min;    ///< [W] unit, orthogonal to `normal`; direction of k_min, sign free
  std::vector<double> k_min;  ///< [W] 1/length, |k_min| <= |k_max|; positive where convex
  std::vector<double> k_max;  ///< [W] 1/length, along normal x t_min
  /// [W] unit, orthogonal to `normal`: one arm of the cross that lines follow, and edges turn to.
  /// Equal to t_min where the cross field was not extended; elsewhere the smooth continuation from
  /// reliable areas, which is free to turn by multiples of a right angle.
  std::vector<Vec3> cross;
  std::vector<double> wedge_confidence;  ///< [W] in [0, 1], mean over the wedge's faces
  std::vector<double> face_confidence;   ///< [F] in [0, 1], [MK04] equation 1, of t_min
  bool cross_extended = false;           ///< whether `cross` is the smooth 4-symmetric extension
  LaidGuides guides;                     ///< that `cross` was made to follow
};

/// Wanted distances between neighbouring lines at every wedge, not graded yet: what tracing takes
/// instead of those that curvature gives, where errors have been measured.
struct SizeField {
  std::string mesh_id;
  std::vector<double> along;   ///< [W] model units, positive, measured along the field's `cross`
  std::vector<double> across;  ///< [W] likewise, measured across it
};

/// How densely a user wants the vertices of the result: vertices per area, relative to what they
/// would be without it.
struct DensityField {
  std::string mesh_id;        ///< "": it goes by the vertices of the file that was imported
  std::vector<double> value;  ///< [vertices of that file] positive
  /// [vertices of that file] where they lie, model coordinates; empty where nobody says
  std::vector<Vec3> position = {};
};

}  // namespace strake
