#pragma once

#include <vector>

#include "common/core/types.h"

namespace strake::fitting {

/// A symmetric, positive definite linear system whose unknowns are vectors in space, one per
/// vertex.
class BlockSystem {
 public:
  /// \param neighbours [n] ascending and symmetric: with which unknowns each one may be coupled
  explicit BlockSystem(const std::vector<std::vector<Index>>& neighbours);

  [[nodiscard]] Index size() const { return static_cast<Index>(diagonal_.size()); }
  void set_zero();
  /// Adds to the block in row i and column j. \pre i = j, or j is a neighbour of i
  void add(Index i, Index j, const Mat3& block);
  void add_right(Index i, const Vec3& value) { right_[i] += value; }
  /// Keeps every unknown within the range of its projection.
  void restrict_to(const std::vector<Mat3>& projections);

  /// The solution, by conjugate gradients with the blocks of the diagonal as preconditioner.
  [[nodiscard]] std::vector<Vec3> solve() const;

 private:
  std::vector<Index> offsets_ = {0};  ///< [n + 1]
  std::vector<Index> columns_;        ///< [E] without the diagonal
  std::vector<Mat3> blocks_;          ///< [E]
  std::vector<Mat3> diagonal_;        ///< [n]
  std::vector<Vec3> right_;           ///< [n]
};

}  // namespace strake::fitting
