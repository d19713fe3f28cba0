#pragma once

#include <array>
#include <vector>

#include "common/core/line_set.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// A straight piece of a line inside one face, as the proximity queries see it.
struct LineSegment {
  Vec3 a;
  Vec3 b;
  Vec3 direction;  ///< unit, in the sense the line runs
  Index line = kNone;
  double arc = 0;  ///< signed length along the line from its seed, at the middle
  LineFamily family = LineFamily::minimum;
  Index next = kNone;  ///< in the list of the same face
};

/// What a query asks for: is a line of the same direction closer than `distance`?
struct ProximityQuery {
  Index face = kNone;
  Vec3 point;
  Vec3 direction;       ///< unit
  double radius = 0;    ///< of the p-cell
  double distance = 0;  ///< conflicts are closer than this, at most `radius`
  LineFamily family = LineFamily::minimum;
  bool by_family = false;  ///< compare families instead of directions ([MK04] section 4.2)
  Index own_line = kNone;
  double own_arc = 0;
  double own_skip = 0;  ///< pieces of the own line nearer than this along the line, to their
                        ///< nearer ends, do not count
  bool ignore_barriers = false;  ///< for a line that has just left a corner of the feature graph
};

struct ProximityHit {
  bool conflict = false;
  Index line = kNone;  ///< that the conflict is with; kNone for a barrier
  double distance = 0;
};

/// Line samples kept per face, and the p-cell walk over faces ([MK04] section 3.2).
///
/// Cells grow over the surface, never through space, and end at barriers (features and boundary),
/// which count as lines themselves.
class ProximityIndex {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines; kept by reference
  ProximityIndex(const TriMesh& mesh, const std::vector<std::uint8_t>& barriers);

  void insert(Index face, LineSegment segment);
  /// Takes back the `count` segments inserted last.
  void remove_last(std::size_t count);
  /// Takes back the segments inserted last, down to `count` of them.
  void shrink(std::size_t count) { remove_last(segments_.size() - count); }
  [[nodiscard]] std::size_t segment_count() const { return segments_.size(); }

  ProximityHit query(const ProximityQuery& query);
  /// Distances to the nearest line of the same direction on the side that `left` points to and on
  /// the other one; the radius where there is none. Barriers count, the own line does not.
  std::pair<double, double> distances_beside(const ProximityQuery& query, const Vec3& left);
  /// Whether `face` was in the cell of the last query.
  [[nodiscard]] bool in_cell(Index face) const { return stamp_[face] == current_; }

  /// The faces of the last query's cell.
  [[nodiscard]] const std::vector<Index>& cell() const { return cell_; }

  [[nodiscard]] std::uint64_t query_count() const { return query_count_; }

 private:
  /// What walking over a face takes, side by side in memory: most of a cell's faces lie within it
  /// as a whole, and need no look at their corners.
  struct Tile {
    std::array<float, 3> centre;
    float radius;                    ///< of a ball around `centre` that holds the face, rounded up
    std::array<Index, 3> neighbour;  ///< face across each edge; kNone at barriers
    Index head = kNone;              ///< first segment
  };

  void grow_cell(Index face, const Vec3& point, double radius);
  void collect_cell(Index face, const Vec3& point, double radius);
  [[nodiscard]] static bool is_occupied(const Tile& tile);

  const TriMesh& mesh_;
  const std::vector<std::uint8_t>& barriers_;
  std::vector<LineSegment> segments_;
  std::vector<Index> segment_face_;
  std::vector<Tile> tiles_;           ///< [F]
  std::vector<std::uint32_t> stamp_;  ///< [F] cell the face was last part of
  std::uint32_t current_ = 0;
  Index cell_face_ = kNone;  ///< what the cell was grown from
  Vec3 cell_point_ = Vec3::Zero();
  double cell_radius_ = 0;
  std::vector<Index> cell_;
  std::vector<Index> occupied_;  ///< faces of the cell with segments or barriers
  std::uint64_t query_count_ = 0;
};

}  // namespace strake
