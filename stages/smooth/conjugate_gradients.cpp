#include "stages/smooth/conjugate_gradients.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>

namespace strake {
namespace {

using Complex = std::complex<double>;
using Vector = std::vector<Complex>;

constexpr Index kBlock = 4096;

/// Calls term(i), which does a part of the work and gives up to two numbers to be summed, for each
/// i below n. \return the two sums
template <class Term>
std::array<double, 2> sum_over(Index n, Term term) {
  const Index blocks = (n + kBlock - 1) / kBlock;
  std::vector<std::array<double, 2>> sums(static_cast<std::size_t>(blocks));
  tbb::parallel_for(Index{0}, blocks, [&](Index block) {
    std::array<double, 2> sum = {0, 0};
    const Index end = std::min<Index>(n, (block + 1) * kBlock);
    for (Index i = block * kBlock; i < end; ++i) {
      const std::array<double, 2> part = term(i);
      sum[0] += part[0];
      sum[1] += part[1];
    }
    sums[static_cast<std::size_t>(block)] = sum;
  });
  std::array<double, 2> total = {0, 0};
  for (const auto& sum : sums) {
    total[0] += sum[0];
    total[1] += sum[1];
  }
  return total;
}

/// Real part of conj(a) * b.
double dot(const Complex& a, const Complex& b) { return a.real() * b.real() + a.imag() * b.imag(); }

Complex row_times(const HermitianMatrix& matrix, Index i, const Vector& x) {
  double real = matrix.diagonal[i] * x[i].real();
  double imag = matrix.diagonal[i] * x[i].imag();
  for (Index at = matrix.offsets[i]; at < matrix.offsets[i + 1]; ++at) {
    const Complex& a = matrix.values[at];
    const Complex& b = x[matrix.columns[at]];
    real += a.real() * b.real() - a.imag() * b.imag();
    imag += a.real() * b.imag() + a.imag() * b.real();
  }
  return {real, imag};
}

}  // namespace

Index solve(const HermitianMatrix& matrix, const Vector& right, const SolverOptions& options,
            Vector& x) {
  const auto n = static_cast<Index>(right.size());
  Vector residual(right.size());
  Vector direction(right.size());
  Vector product(right.size());

  const auto [right_norm2, first_norm2] = sum_over(n, [&](Index i) -> std::array<double, 2> {
    residual[i] = right[i] - row_times(matrix, i, x);
    return {std::norm(right[i]), std::norm(residual[i])};
  });
  const double enough = options.tolerance * options.tolerance * right_norm2;
  if (first_norm2 <= enough) return 0;
  double slope = sum_over(n, [&](Index i) -> std::array<double, 2> {
    direction[i] = residual[i] / matrix.diagonal[i];
    return {dot(residual[i], direction[i]), 0};
  })[0];
  for (Index iteration = 1; iteration <= options.max_iterations; ++iteration) {
    const double bend = sum_over(n, [&](Index i) -> std::array<double, 2> {
      product[i] = row_times(matrix, i, direction);
      return {dot(direction[i], product[i]), 0};
    })[0];
    const double step = slope / bend;
    const auto [norm2, next_slope] = sum_over(n, [&](Index i) -> std::array<double, 2> {
      x[i] += step * direction[i];
      residual[i] -= step * product[i];
      const double norm = std::norm(residual[i]);
      return {norm, norm / matrix.diagonal[i]};
    });
    if (!(norm2 > enough)) return iteration;
    const double keep = next_slope / slope;
    slope = next_slope;
    tbb::parallel_for(Index{0}, (n + kBlock - 1) / kBlock, [&](Index block) {
      const Index end = std::min<Index>(n, (block + 1) * kBlock);
      for (Index i = block * kBlock; i < end; ++i) {
        direction[i] = residual[i] / matrix.diagonal[i] + keep * direction[i];
      }
    });
  }
  return options.max_iterations;
}

}  // namespace strake
