#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/core/edge_list.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "stages/import/soup.h"

namespace strake::import {

/// The edges of a list after the repairs: vertices of the input count as one that lie at the same
/// place or were joined, and edges that got vertices inside as their parts.
class ListedEdges {
 public:
  /// \param input  the polygons that the list's numbers refer to
  /// \param soup   what repairs made of them
  /// \throw InputError naming the list's file, line and a remedy where there is no such vertex
  ListedEdges(const EdgeList& list, const PolyMesh& input, const Soup& soup);

  /// Flags them as features. \return inner edges flagged
  /// \throw InputError likewise where there is no such edge
  Index flag(TriMesh& mesh) const;

 private:
  using Ends = std::pair<Index, Index>;  ///< numbers of vertices, the lower one first

  [[nodiscard]] Ends ends_of(Index a, Index b) const { return std::minmax(number_[a], number_[b]); }
  void divide(const std::vector<DividedEdge>& divided);

  EdgeList list_;
  std::vector<Index> number_;  ///< [V of the input] equal for those that count as one
};

}  // namespace strake::import
