#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/cell_error/compared_surfaces.h"
#include "common/geometry/surface_lines.h"
#include "stages/refine/inlaid.h"
#include "stages/refine/inlay.h"

namespace strake {

struct Ball {
  Vec3 middle;  ///< relative to the input's origin
  double radius;
};

/// How far an inlay is thinned out (thin_out.h), from vertex to vertex: by one of a few distances,
/// or not at all. Vertices of its outline stay, and those on feature and boundary lines.
class Thinning {
 public:
  /// Changes from the largest distance to none.
  static constexpr std::size_t kLevels = 4;

  /// As far as possible.
  /// \param surfaces  with the result that the inlay is for
  /// \param lines     of the input
  Thinning(const ComparedSurfaces& surfaces, const SurfaceLines& lines, const Inlay& inlay);

  /// The faces that are left, with corners as in the inlay.
  /// \param tolerance  of which distances are shares
  [[nodiscard]] std::vector<std::array<Index, 3>> faces(double tolerance) const;

  /// Thins out less in some balls.
  /// \param scale   of their radii
  /// \param levels  changes to smaller distances
  /// \return whether there is any vertex for which that changes anything
  bool lessen(const std::vector<Ball>& balls, double scale, std::size_t levels);

 private:
  std::vector<Vec3> positions_;              ///< [V] relative to the input's origin
  std::vector<std::array<Index, 3>> faces_;  ///< of the inlay
  std::vector<std::size_t> level_;  ///< [V] from the largest distance, 0, to `kLevels`: none
};

/// Takes vertices out of inlays, fewer around faces that are beyond the tolerance or cross others
/// then; of what is within it, that is taken of which the fewest cross.
/// \pre none is beyond it
/// \param distance  by which to thin out, at most the tolerance
void thin(const InlayHost& host, double distance, std::vector<Inlay>& inlays);

/// Thins inlays out by the least of some distances after which no faces cross and there are not
/// many more vertices than without any; else by that after which the fewest cross, or of which
/// the fewest vertices come.
/// \pre as for `thin`
/// \param distance  the first one; then twice as much, up to the tolerance
void thin_from(const InlayHost& host, double distance, std::vector<Inlay>& inlays);

}  // namespace strake
