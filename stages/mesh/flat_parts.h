#pragma once

#include <utility>
#include <vector>

#include "common/geometry/frames.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Parts of the cells of a graph that are nearly flat: cells in one plane that are joined by edges
/// other than features, seen along the normal of that plane.
///
/// Cells and edges are told apart by one of their darts. After the graph has changed within a part
/// `update` must be called for it; the others stay as they were found.
class FlatParts {
 public:
  /// Finds all parts of two or more cells. \param graph  kept by reference
  explicit FlatParts(const PolygonGraph& graph);

  [[nodiscard]] Index size() const { return static_cast<Index>(parts_.size()); }
  [[nodiscard]] const std::vector<Index>& cells(Index part) const { return parts_[part].cells; }
  /// The cell of a part left of a dart, as in `cells`.
  [[nodiscard]] Index cell_of(Index dart) const { return cell_of_[dart]; }
  /// Where a node lies in the plane of a part.
  [[nodiscard]] Vec2 place(Index part, Index node) const {
    return parts_[part].frame.tangent_from_world(graph_.position(node) - parts_[part].origin);
  }
  /// Whether the edge is no feature and has cells of the part on both sides.
  [[nodiscard]] bool is_inside(Index part, Index dart) const;

  /// Pairs of edges, each by a dart, that meet in the plane but have no node in common.
  using Crossings = std::vector<std::pair<Index, Index>>;

  /// Those of the edges around a part and around its holes, and of features in it.
  [[nodiscard]] Crossings outline_crossings(Index part) const;
  /// Those of all edges of a part. Where nothing is turned, no outlines cross and no cell crosses
  /// itself there are none.
  /// Both end early where they are so many that several sheets lie on each other (see `is_tangle`).
  [[nodiscard]] Crossings crossings(Index part) const;
  [[nodiscard]] bool is_tangle(Index part, const Crossings& crossings) const;
  /// Darts of a part at nodes around which corners are in another order than their darts, or that
  /// are corners of a cell turned over or without area.
  [[nodiscard]] std::vector<Index> turned(Index part) const;

  /// Looks at the graph again, where edges of a part were split.
  void update(Index part);
  /// Likewise, where cells were replaced by others.
  void replace(Index part, const std::vector<Index>& old, const std::vector<Index>& made);

 private:
  struct Part {
    std::vector<Index> cells;
    TangentFrame frame;
    Vec3 origin;
  };

  /// The cells in the plane of one that are reached over edges inside it, none of those taken.
  [[nodiscard]] std::vector<Index> grow(Index first, std::vector<char>& taken) const;
  [[nodiscard]] bool has(Index part, Index dart) const { return part_of_[dart] == part; }
  [[nodiscard]] Crossings crossings(Index part, bool with_inside) const;
  /// Darts with a cell of the part on their left.
  [[nodiscard]] std::vector<Index> darts(Index part) const;

  const PolygonGraph& graph_;
  std::vector<Part> parts_;
  std::vector<Index> part_of_;  ///< [darts] kNone: of no part
  std::vector<Index> cell_of_;  ///< [darts] where they are of a part
};

}  // namespace strake
