#pragma once

#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"
#include "stages/trace/face_blocks.h"

namespace strake {

/// Stands for a line that is being traced, and has no number yet.
inline constexpr Index kOwnLine = kNone - 1;

/// A straight piece of a line inside one face, as the proximity queries see it.
struct LineSegment {
  Vec3 a;
  Vec3 b;
  Vec3 direction;  ///< unit, in the sense the line runs
  Index face = kNone;
  Index line = kOwnLine;
  LineFamily family = LineFamily::minimum;
};

/// Pieces of lines in lists by slab, latest first.
class SegmentLists {
 public:
  /// \param blocks  kept by reference
  explicit SegmentLists(const FaceBlocks& blocks)
      : blocks_(blocks), head_(blocks.slab_count(), kNone) {}

  void push(const LineSegment& segment);
  /// Takes back the pieces pushed last, down to `count` of them.
  void shrink(std::size_t count);
  [[nodiscard]] const std::vector<LineSegment>& all() const { return segments_; }

  /// Calls use(segment, number) for the pieces in a block that may be nearer to a point than
  /// `distance`; for some more than once.
  template <class Use>
  void for_near(Index block, const Vec3& point, double distance, const Use& use) const {
    const auto [first, last] = blocks_.slabs(block, point, point, distance);
    for (Index slab = first; slab < last; ++slab) {
      for (Index n = head_[slab]; n != kNone; n = nodes_[n].next) {
        use(segments_[nodes_[n].segment], nodes_[n].segment);
      }
    }
  }

 private:
  struct Node {
    Index segment;
    Index slab;
    Index next;
  };

  const FaceBlocks& blocks_;
  std::vector<LineSegment> segments_;
  std::vector<Node> nodes_;  ///< one for each slab that a piece is in
  std::vector<Index> head_;  ///< [slabs] latest node
};

/// What a query asks for: is a line of the same direction closer than `distance`?
struct ProximityQuery {
  Index face = kNone;
  Vec3 point;
  Vec3 direction;       ///< unit
  double distance = 0;  ///< conflicts are closer than this
  LineFamily family = LineFamily::minimum;
  bool by_family = false;  ///< compare families instead of directions ([MK04] section 4.2)
  double own_arc = 0;      ///< signed length along the own line from its seed
  double own_skip = 0;     ///< pieces of the own line nearer than this along the line, to their
                           ///< nearer ends, do not count
  bool ignore_barriers = false;  ///< for a line that has just left a corner of the feature graph

  /// Whether a piece of a line counts by its direction.
  [[nodiscard]] bool is_alike(const LineSegment& segment) const {
    return by_family ? segment.family == family : is_alike(segment.direction);
  }
  [[nodiscard]] bool is_alike(const Vec3& unit) const {
    return std::abs(unit.dot(direction)) > M_SQRT1_2;
  }
};

struct ProximityHit {
  bool conflict = false;
  Index line = kNone;  ///< that the conflict is with; kNone for a barrier, kOwnLine for itself
  double distance = 0;
};

/// The pieces of all finished lines, by block, and the barriers.
class ProximityIndex {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines, where blocks end; all kept by
  ///                 reference
  ProximityIndex(const FaceBlocks& blocks, const std::vector<std::uint8_t>& barriers);

  /// Adds a finished line.
  void insert(std::span<const LineSegment> segments, Index line);

  [[nodiscard]] Index segment_count() const { return static_cast<Index>(segments_.all().size()); }
  [[nodiscard]] const SegmentLists& segments() const { return segments_; }
  [[nodiscard]] const FaceBlocks& blocks() const { return blocks_; }

  /// A feature or boundary edge.
  struct Barrier {
    Vec3 a;
    Vec3 b;
    Vec3 direction;  ///< unit
    Vec3 middle;
    double half_length = 0;  ///< rounded up
    Index halfedge = kNone;
  };
  /// Calls use(barrier) for those around a block that may be nearer to a point than `distance`.
  template <class Use>
  void for_barriers(Index block, const Vec3& point, double distance, const Use& use) const {
    for (Index at = first_barrier_[block]; at < first_barrier_[block + 1]; ++at) {
      const Barrier& barrier = barriers_[at];
      const double reach = distance + barrier.half_length;
      if ((barrier.middle - point).squaredNorm() <= reach * reach) use(barrier);
    }
  }

 private:
  void add_barrier(Index halfedge);

  const FaceBlocks& blocks_;
  std::vector<Index> first_barrier_;  ///< [B + 1] into barriers_
  std::vector<Barrier> barriers_;
  SegmentLists segments_;
};

/// What one line sees around it: finished lines, barriers, and what it has recorded itself.
class ProximityProbe {
 public:
  /// \param index  kept by reference
  explicit ProximityProbe(const ProximityIndex& index);

  /// Forgets the own line.
  void clear();

  /// Appends a piece to the own line. \param arc  signed length from the seed, at its middle
  void record(const LineSegment& segment, double arc);
  /// Takes back the pieces recorded last, down to `count` of them.
  void shrink(std::size_t count);
  [[nodiscard]] const std::vector<LineSegment>& recorded() const { return segments_.all(); }

  ProximityHit query(const ProximityQuery& query);
  /// Distances to the nearest line of the same direction on the side that `left` points to and on
  /// the other one; the query's distance where there is none. Barriers count, the own line does
  /// not.
  std::pair<double, double> distances_beside(const ProximityQuery& query, const Vec3& left);

  /// The nearest corner of feature and boundary lines within the query's distance that lies ahead,
  /// in its direction.
  /// \param least_cosine  of the angle to it
  /// \return kNone where there is none
  Index corner_ahead(const ProximityQuery& query, double least_cosine);

  /// Whether a walk from a point of a face comes to the block of another one within a distance.
  bool can_reach(Index face, const Vec3& point, double distance, Index target);

  /// Questions since it was cleared.
  [[nodiscard]] std::int64_t query_count() const { return query_count_; }

 private:
  const ProximityIndex& index_;
  BlockWalk walk_;
  SegmentLists segments_;     ///< of the own line
  std::vector<double> arcs_;  ///< of each
  std::int64_t query_count_ = 0;
};

}  // namespace strake
