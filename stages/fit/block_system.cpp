#include "stages/fit/block_system.h"

#include <tbb/parallel_for.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "common/geometry/conjugate_gradients.h"

namespace strake::fitting {
namespace {

/// Moves are measured again in the next round, so little is won by solving more exactly.
constexpr SolverOptions kSolver = {.tolerance = 1e-4, .max_iterations = 300};

}  // namespace

BlockPattern::BlockPattern(const std::vector<std::vector<Index>>& neighbours) {
  for (const std::vector<Index>& row : neighbours) {
    columns.insert(columns.end(), row.begin(), row.end());
    offsets.push_back(static_cast<Index>(columns.size()));
  }
}

BlockSystem::BlockSystem(const BlockPattern& pattern)
    : pattern_(pattern),
      blocks_(pattern.columns.size(), Mat3::Zero()),
      diagonal_(pattern.offsets.size() - 1, Mat3::Zero()),
      right_(diagonal_.size(), Vec3::Zero()) {}

void BlockSystem::add(Index i, Index j, const Mat3& block) {
  if (i == j) {
    diagonal_[i] += block;
    return;
  }
  const auto& [offsets, columns] = pattern_;
  const auto end = columns.begin() + offsets[i + 1];
  const auto at = std::lower_bound(columns.begin() + offsets[i], end, j);
  blocks_[at - columns.begin()] += block;
}

void BlockSystem::restrict_to(const std::vector<Mat3>& projections) {
  tbb::parallel_for(std::size_t{0}, diagonal_.size(), [&](std::size_t i) {
    const Mat3& own = projections[i];
    // What an unknown may not do is an equation of its own, of the same size: 0 = 0.
    const double scale = std::max(diagonal_[i].trace(), std::numeric_limits<double>::min());
    diagonal_[i] = own * diagonal_[i] * own + scale * (Mat3::Identity() - own);
    right_[i] = own * right_[i];
    for (Index at = pattern_.offsets[i]; at < pattern_.offsets[i + 1]; ++at) {
      blocks_[at] = own * blocks_[at] * projections[pattern_.columns[at]];
    }
  });
}

std::vector<Vec3> BlockSystem::solve() const {
  std::vector<Mat3> inverse(diagonal_.size());
  std::transform(diagonal_.begin(), diagonal_.end(), inverse.begin(),
                 [](const Mat3& block) { return block.inverse(); });
  std::vector<Vec3> x(diagonal_.size(), Vec3::Zero());
  SolverVectors<Vec3> vectors{.right = right_};
  conjugate_gradients(
      kSolver,
      [this](Index i, const std::vector<Vec3>& y) -> Vec3 {
        Vec3 sum = diagonal_[i] * y[i];
        for (Index at = pattern_.offsets[i]; at < pattern_.offsets[i + 1]; ++at) {
          sum += blocks_[at] * y[pattern_.columns[at]];
        }
        return sum;
      },
      [&inverse](Index i, const Vec3& value) -> Vec3 { return inverse[i] * value; },
      [](const Vec3& a, const Vec3& b) { return a.dot(b); }, x, vectors);
  return x;
}

}  // namespace strake::fitting
