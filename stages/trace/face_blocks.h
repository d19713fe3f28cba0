#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/core/tri_mesh.h"
#include "stages/trace/spacing.h"

namespace strake {

/// Smallest wanted distance of lines at the corners of a face, model units.
double least_spacing(const TriMesh& mesh, const Spacing& spacing, Index face);

/// Whether a face is larger than lines are apart, so that several may run through it side by side.
bool is_large_face(const TriMesh& mesh, const Spacing& spacing, Index face);

/// The faces of a mesh in connected blocks about as large as lines are apart, so that a look around
/// takes a few steps however fine the mesh is.
///
/// A large face is a block of its own, cut into slabs across its longest edge where it is much
/// longer than lines are apart. No block reaches across a barrier, or around a rim: the two sides
/// of a thin wall are in different ones.
class FaceBlocks {
 public:
  /// \param barriers [3F] half-edges that walks and blocks end at, as at the boundary; kept by
  ///                 reference
  FaceBlocks(const TriMesh& mesh, const Spacing& spacing,
             const std::vector<std::uint8_t>& barriers);

  [[nodiscard]] Index count() const { return static_cast<Index>(balls_.size()); }
  [[nodiscard]] Index block_of(Index face) const { return block_of_[face]; }
  [[nodiscard]] std::span<const Index> faces(Index block) const {
    return {faces_.data() + first_face_[block], faces_.data() + first_face_[block + 1]};
  }
  [[nodiscard]] bool is_single(Index block) const { return faces(block).size() == 1; }
  [[nodiscard]] const TriMesh& mesh() const { return mesh_; }

  /// Slabs of all blocks; most have one.
  [[nodiscard]] Index slab_count() const { return first_slab_.back(); }
  /// The slabs of a block that hold what is not farther than `distance` from segment a-b in it:
  /// from the first number on, up to the second one.
  [[nodiscard]] std::pair<Index, Index> slabs(Index block, const Vec3& a, const Vec3& b,
                                              double distance) const;

 private:
  friend class BlockWalk;

  /// Holds a block; single precision, rounded up.
  struct Ball {
    std::array<float, 3> centre;
    float radius;
  };
  /// A way into a neighbouring block: over this half-edge, or anywhere where it is kNone.
  struct Way {
    Index block;
    Index halfedge;
  };

  [[nodiscard]] bool ends_at(Index h) const { return barriers_[h] != 0 || mesh_.is_boundary(h); }
  void gather(Index first, const Spacing& spacing);
  [[nodiscard]] Ball ball_around(std::span<const Index> faces, double rounding) const;
  void find_ways();
  void cut(const Spacing& spacing);

  const TriMesh& mesh_;
  const std::vector<std::uint8_t>& barriers_;
  std::vector<Index> block_of_;    ///< [F]
  std::vector<Index> first_face_;  ///< [B + 1] into faces_
  std::vector<Index> faces_;       ///< [F]
  std::vector<Ball> balls_;        ///< [B]
  std::vector<Index> first_slab_;  ///< [B + 1]
  std::vector<Index> first_way_;   ///< [B + 1] into ways_
  std::vector<Way> ways_;
};

/// The p-cell walk ([MK04] section 3.2) over blocks: over the surface, never through space.
class BlockWalk {
 public:
  /// \param blocks  kept by reference
  explicit BlockWalk(const FaceBlocks& blocks) : blocks_(blocks), stamp_(blocks.count(), 0) {}

  /// Blocks that can be reached from a face over blocks, and edges of large faces, which are not
  /// farther than `distance` from a point of that face. Calls use(block) for each, which returns
  /// the distance for those after it: what is nearest so far, where nothing farther matters.
  template <class Use>
  void around(Index face, const Vec3& point, double distance, const Use& use) {
    start(face);
    for (std::size_t at = 0; at < cell_.size(); ++at) {
      if (at > 0 && !is_within(cell_[at], point, distance)) continue;
      distance = use(cell_[at]);
      go_on_from(cell_[at], point, distance);
    }
  }

  /// Whether the last walk came to the block of a face.
  [[nodiscard]] bool reached(Index face) const {
    return stamp_[blocks_.block_of(face)] == current_;
  }

 private:
  void start(Index face);
  /// Appends those beside a block that are near enough, and were not there yet.
  void go_on_from(Index block, const Vec3& point, double distance);
  /// Whether a block may have something nearer to a point than `distance`.
  [[nodiscard]] bool is_within(Index block, const Vec3& point, double distance) const {
    const auto& [centre, radius] = blocks_.balls_[block];
    const double reach = distance + radius;
    return (Vec3(centre[0], centre[1], centre[2]) - point).squaredNorm() <= reach * reach;
  }

  const FaceBlocks& blocks_;
  std::vector<std::uint32_t> stamp_;  ///< [B] walk that came there last
  std::uint32_t current_ = 0;
  std::vector<Index> cell_;
};

}  // namespace strake
