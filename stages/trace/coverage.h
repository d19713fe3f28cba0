#pragma once

#include <vector>

#include "stages/trace/sampling.h"

namespace strake {

/// Keeps track of where on the surface a line of each direction passes near by.
///
/// The surface is sampled at its wedges, and inside faces that are larger than the distance of
/// lines. What no line has come near by the end is where seeds are still worth trying: testing
/// every face instead would fail nine times out of ten.
class Coverage {
 public:
  explicit Coverage(const TraceDomain& domain);

  /// Marks what lies within `distance` of a point of a line.
  /// \param faces  all faces that can be reached from the point over edges within `distance`
  void mark(const std::vector<Index>& faces, const Vec3& point, const Vec3& direction,
            double distance);

  /// A place on the surface and one arm of its cross.
  struct Gap {
    Index face = kNone;
    Vec3 barycentric;
    Vec3 direction;  ///< world
  };
  /// Calls use(gap) for each uncovered arm in `face`, as they are when their turn comes.
  template <class Use>
  void for_gaps(Index face, const Use& use) const {
    for (int corner = 0; corner < 3; ++corner) {
      for (int arm = 0; arm < 2; ++arm) {
        if (is_gap(wedge_marks_[domain_.mesh.face_wedges[face][corner]], arm)) {
          use(corner_gap(face, corner, arm));
        }
      }
    }
    for (Index p = offsets_[face]; p < offsets_[face + 1]; ++p) {
      for (int arm = 0; arm < 2; ++arm) {
        if (is_gap(points_[p].marks, arm)) use(point_gap(face, p, arm));
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
  [[nodiscard]] Gap corner_gap(Index face, int corner, int arm) const;
  [[nodiscard]] Gap point_gap(Index face, Index point, int arm) const;

  const TraceDomain& domain_;
  std::vector<std::uint8_t> wedge_marks_;  ///< [W] bit 0: along the cross, bit 1: across it
  std::vector<std::uint8_t> own_corners_;  ///< [F] bits of the corners that stand for their wedges
  std::vector<Index> offsets_;             ///< [F + 1] into points_
  std::vector<Point> points_;
};

}  // namespace strake
