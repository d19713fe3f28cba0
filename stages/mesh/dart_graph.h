#pragma once

#include <vector>

#include "common/core/types.h"

namespace strake {

/// A graph embedded on a surface, as half-edges ("darts") of an oriented rotation system.
///
/// Edge e has the darts 2 e and 2 e + 1, each other's opposites. Following `next` walks around the
/// cell to the left of a dart. The graph may have loops, multiple edges and dangling ends; as long
/// as it only changes by the operations below that link it themselves, its cells stay disks and its
/// Euler characteristic stays that of the surface: every operation adds or removes an edge together
/// with exactly one cell or one node.
class DartGraph {
 public:
  static Index opposite(Index dart) { return dart ^ 1; }
  static Index edge_of(Index dart) { return dart >> 1; }

  [[nodiscard]] Index dart_count() const { return static_cast<Index>(next_.size()); }
  [[nodiscard]] Index next(Index dart) const { return next_[dart]; }
  [[nodiscard]] Index prev(Index dart) const { return prev_[dart]; }
  [[nodiscard]] Index from(Index dart) const { return origin_[dart]; }
  [[nodiscard]] Index to(Index dart) const { return origin_[dart ^ 1]; }
  [[nodiscard]] bool is_alive(Index dart) const { return next_[dart] != kNone; }
  /// The next dart leaving from(dart), counter-clockwise.
  [[nodiscard]] Index rotate_ccw(Index dart) const { return prev_[dart] ^ 1; }

  void reserve(std::size_t darts);
  /// Adds an edge without links; the caller links it.
  Index add_edge(Index from, Index to);
  void link(Index dart, Index following) {
    next_[dart] = following;
    prev_[following] = dart;
  }

  /// Splits the cell on the left of `a` and `b` by an edge from from(a) to from(b).
  /// \pre a and b lie on the same cell
  /// \return the new dart, from from(a) to from(b); b follows it
  Index connect(Index a, Index b);

  /// Puts `node` into the edge of `dart`. \return the new dart: the second half of `dart`'s way
  Index split_edge(Index dart, Index node);

  /// Removes an edge: merges the cells beside it, or takes a dangling edge away with its end node.
  /// \pre the cells beside it differ, or one end has degree one
  void remove_edge(Index dart);

  /// Takes edges away without linking what is around them; the caller does.
  /// \param darts  one of each edge
  void drop_edges(const std::vector<Index>& darts);

  /// Joins the two edges at the degree-two node from(dart); keeps prev(dart)'s edge.
  /// \pre degree two, and not both ends of one loop
  void dissolve_node(Index dart);

  /// Contracts an edge: from(dart) is merged into to(dart). Triangles beside it become bigons.
  /// \pre from(dart) != to(dart)
  void contract(Index dart);

  /// Visits the edges that end in nodes of degree one, and what does once they are gone, each from
  /// its free end.
  /// \param remove  (dart from the node before to the free end) -> whether it removed that edge;
  /// else the next free end follows
  template <class Remove>
  void take_back_free_ends(const Remove& remove) const;

 private:
  std::vector<Index> next_;
  std::vector<Index> prev_;
  std::vector<Index> origin_;
};

template <class Remove>
void DartGraph::take_back_free_ends(const Remove& remove) const {
  for (Index start = 0; start < dart_count(); ++start) {
    Index d = start;
    while (is_alive(d) && next(d) == opposite(d)) {
      const Index before = prev(d);
      if (!remove(d) || before == opposite(d)) break;
      d = before;
    }
  }
}

}  // namespace strake
