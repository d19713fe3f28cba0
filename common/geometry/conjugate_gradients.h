#pragma once

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <vector>

#include "common/core/types.h"

namespace strake {

struct SolverOptions {
  double tolerance = 1e-5;  ///< on the norm of the residual, as a share of that of the right side
  Index max_iterations = 2000;
};

namespace conjugate_gradients_detail {

constexpr Index kBlock = 4096;

/// Calls work(begin, end) for blocks of a fixed size that make up 0 .. n - 1, in parallel.
template <class Work>
void for_blocks(Index n, Work work) {
  tbb::parallel_for(Index{0}, (n + kBlock - 1) / kBlock, [&](Index block) {
    work(block * kBlock, std::min<Index>(n, (block + 1) * kBlock));
  });
}

/// Calls term(i), which does a part of the work and gives two numbers to be summed, for each i
/// below n.
/// \return the two sums, added up in order over the blocks
template <class Term>
std::array<double, 2> sum_over(Index n, Term term) {
  std::vector<std::array<double, 2>> sums(static_cast<std::size_t>((n + kBlock - 1) / kBlock));
  for_blocks(n, [&](Index begin, Index end) {
    std::array<double, 2> sum = {0, 0};
    for (Index i = begin; i < end; ++i) {
      const std::array<double, 2> part = term(i);
      sum[0] += part[0];
      sum[1] += part[1];
    }
    sums[static_cast<std::size_t>(begin / kBlock)] = sum;
  });
  std::array<double, 2> total = {0, 0};
  for (const auto& sum : sums) {
    total[0] += sum[0];
    total[1] += sum[1];
  }
  return total;
}

}  // namespace conjugate_gradients_detail

/// What solving takes besides the matrix; solves of the same size one after the other may share it,
/// which spares fetching the memory anew.
template <class Value>
struct SolverVectors {
  std::vector<Value> right;  ///< [n] the right side of the system; the residual after solving
  std::vector<Value> direction = {};
  std::vector<Value> product = {};
};

/// Solves a Hermitian, positive definite system A x = right by preconditioned conjugate gradients.
///
/// Works in parallel. Sums are taken over blocks of a fixed size and added up in order, so the
/// result is the same for any number of threads (Eigen's solver is sequential).
/// \tparam Value        of an unknown: a number or a vector
/// \param row_times     (i, x) -> row i of A times x
/// \param precondition  (i, value) -> row i of an approximate inverse of A's diagonal times value
/// \param dot           (a, b) -> real scalar product of two values
/// \param x             [n] first guess, then the solution
/// \param vectors       the right side, the rest of any content
/// \return number of iterations
template <class Value, class RowTimes, class Precondition, class Dot>
Index conjugate_gradients(const SolverOptions& options, RowTimes row_times,
                          Precondition precondition, Dot dot, std::vector<Value>& x,
                          SolverVectors<Value>& vectors) {
  using conjugate_gradients_detail::for_blocks;
  using conjugate_gradients_detail::sum_over;
  using Sums = std::array<double, 2>;
  const auto n = static_cast<Index>(x.size());
  std::vector<Value>& residual = vectors.right;
  std::vector<Value>& direction = vectors.direction;
  std::vector<Value>& product = vectors.product;
  for (auto* vector : {&direction, &product}) vector->resize(x.size());

  const auto [right_norm2, first_norm2] = sum_over(n, [&](Index i) -> Sums {
    const Value right = residual[i];
    residual[i] = right - row_times(i, x);
    return {dot(right, right), dot(residual[i], residual[i])};
  });
  const double enough = options.tolerance * options.tolerance * right_norm2;
  if (first_norm2 <= enough) return 0;
  double slope = sum_over(n, [&](Index i) -> Sums {
    direction[i] = precondition(i, residual[i]);
    return {dot(residual[i], direction[i]), 0};
  })[0];
  for (Index iteration = 1; iteration <= options.max_iterations; ++iteration) {
    const double bend = sum_over(n, [&](Index i) -> Sums {
      product[i] = row_times(i, direction);
      return {dot(direction[i], product[i]), 0};
    })[0];
    const double step = slope / bend;
    const auto [norm2, next_slope] = sum_over(n, [&](Index i) -> Sums {
      x[i] += step * direction[i];
      residual[i] -= step * product[i];
      return {dot(residual[i], residual[i]), dot(residual[i], precondition(i, residual[i]))};
    });
    if (!(norm2 > enough)) return iteration;
    const double keep = next_slope / slope;
    slope = next_slope;
    for_blocks(n, [&](Index begin, Index end) {
      for (Index i = begin; i < end; ++i) {
        direction[i] = precondition(i, residual[i]) + keep * direction[i];
      }
    });
  }
  return options.max_iterations;
}

}  // namespace strake
