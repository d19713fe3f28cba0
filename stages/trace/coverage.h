#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stages/trace/face_blocks.h"
#include "stages/trace/sampling.h"

namespace strake {

/// Where a line passes, and how far around it covers the surface.
struct CoveredDisc {
  Index face = kNone;
  Vec3 point;
  Vec3 direction;       ///< of the line
  double distance = 0;  ///< model units
};

/// Keeps track of where on the surface a line of each direction passes near by.
///
/// The surface is sampled at its wedges, and inside faces that are larger than the distance of
/// lines. What no line has come near by the end is where seeds are still worth trying: testing
/// every face instead would fail nine times out of ten.
class Coverage {
 public:
  /// \param blocks  of the same mesh; both kept by reference
  Coverage(const TraceDomain& domain, const FaceBlocks& blocks);

  /// Marks what lies in a disc. Several threads may do so at the same time.
  void mark(const CoveredDisc& disc, BlockWalk& walk);

  /// A place on the surface and one arm of its cross.
  struct Gap {
    Index face = kNone;
    Vec3 barycentric;
    Vec3 direction;  ///< world
  };
  /// Calls use(gap) once for each arm that is uncovered when its turn comes, face by face; a wedge
  /// is looked at in the first of its faces.
  template <class Use>
  void for_gaps(const Use& use) const {
    std::vector<std::uint8_t> is_done(wedge_marks_.size(), 0);
    for (Index face = 0; face < domain_.mesh.face_count(); ++face) {
      for (int corner = 0; corner < 3; ++corner) {
        const Index wedge = domain_.mesh.face_wedges[face][corner];
        if (std::exchange(is_done[wedge], 1) != 0) continue;
        for (int arm = 0; arm < 2; ++arm) {
          if (is_gap(wedge_marks_[wedge], arm)) use(corner_gap(face, corner, arm));
        }
      }
      for (Index p = offsets_[face]; p < offsets_[face + 1]; ++p) {
        for (int arm = 0; arm < 2; ++arm) {
          if (is_gap(points_[p].marks, arm)) use(point_gap(face, p, arm));
        }
      }
    }
  }

  /// Share of the arms that are covered, from a sample; for progress only.
  [[nodiscard]] double covered_share() const;

 private:
  struct Point {
    Vec3 barycentric;
    Vec3 position;
    Vec3 arm;  ///< world, unit
    std::uint8_t marks = 0;
  };

  static bool is_gap(std::uint8_t marks, int arm) { return (marks >> arm & 1) == 0; }
  void sample_face(Index face);
  void mark_corners(Index block, const CoveredDisc& disc);
  void mark_points(Index face, const CoveredDisc& disc);
  [[nodiscard]] Gap corner_gap(Index face, int corner, int arm) const;
  [[nodiscard]] Gap point_gap(Index face, Index point, int arm) const;

  const TraceDomain& domain_;
  const FaceBlocks& blocks_;
  std::vector<std::uint8_t> wedge_marks_;  ///< [W] bit 0: along the cross, bit 1: across it
  std::vector<Index> first_corner_;        ///< [B + 1] into corners_
  std::vector<Index> corners_;             ///< [W] half-edges, one for each wedge, by block
  std::vector<Index> open_corners_;        ///< [B] corners whose arms are not all covered
  std::vector<Index> offsets_;             ///< [F + 1] into points_
  std::vector<Point> points_;
};

}  // namespace strake
