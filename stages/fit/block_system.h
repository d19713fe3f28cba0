#pragma once

#include <vector>

#include "common/core/types.h"

namespace strake::fitting {

/// Which unknowns of a system may be coupled with which.
struct BlockPattern {
  /// \param neighbours [n] ascending and symmetric
  explicit BlockPattern(const std::vector<std::vector<Index>>& neighbours);

  std::vector<Index> offsets = {0};  ///< [n + 1]
  std::vector<Index> columns;        ///< [E] of each row in turn, without the diagonal
};

/// A symmetric, positive definite linear system whose unknowns are vectors in space, one per
/// vertex.
class BlockSystem {
 public:
  /// With all blocks zero. \param pattern  kept by reference
  explicit BlockSystem(const BlockPattern& pattern);

  /// Adds to the block in row i and column j. \pre i = j, or j is a neighbour of i
  void add(Index i, Index j, const Mat3& block);
  void add_right(Index i, const Vec3& value) { right_[i] += value; }
  /// Keeps every unknown within the range of its projection.
  void restrict_to(const std::vector<Mat3>& projections);

  /// The solution, by conjugate gradients with the blocks of the diagonal as preconditioner.
  [[nodiscard]] std::vector<Vec3> solve() const;

 private:
  const BlockPattern& pattern_;
  std::vector<Mat3> blocks_;    ///< [E]
  std::vector<Mat3> diagonal_;  ///< [n]
  std::vector<Vec3> right_;     ///< [n]
};

}  // namespace strake::fitting
