#pragma once

#include <utility>
#include <vector>

#include "stages/mesh/cell_shape.h"

namespace strake {

/// Nodes that are about to move, and where to.
class Moves {
 public:
  void add(Index node, const Vec3& to) { moves_.emplace_back(node, to); }
  [[nodiscard]] const Vec3* find(Index node) const;

 private:
  std::vector<std::pair<Index, Vec3>> moves_;
};

/// Penalty of a face as it is (see shape_penalty).
double penalty_now(const Polygon& p);

/// Penalty of a face after a change; infinite where it is concave or has turned by more than 60
/// degrees.
/// \param normal_before  vector area of what the face was made of
double changed_penalty(const Polygon& p, const Vec3& normal_before);

/// The cells at the origins of darts, by their least darts; no holes.
std::vector<Index> cells_around(const PolygonGraph& graph, const std::vector<Index>& darts);

/// By how much the shapes of cells gain when nodes move; corners that come to the same place are
/// one, and what has two left is no face any more. Minus infinity where a face would be concave or
/// turned, or worse than before and than `worst`.
double gain_of_moves(const PolygonGraph& graph, const std::vector<Index>& cells, const Moves& moves,
                     double worst);

}  // namespace strake
