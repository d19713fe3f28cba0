#include "stages/smooth/hermitian_matrix.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Dense>
#include <random>

namespace strake {
namespace {

using Complex = std::complex<double>;

/// A diagonally dominant Hermitian matrix over a ring with chords, and a right side.
struct Problem {
  explicit Problem(Index n) : right(static_cast<std::size_t>(n)) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    std::vector<std::vector<std::pair<Index, Complex>>> rows(static_cast<std::size_t>(n));
    diagonal.assign(static_cast<std::size_t>(n), 0.1);
    for (Index i = 0; i < n; ++i) {
      for (const Index j : {(i + 1) % n, (i * 7 + 3) % n}) {
        if (i == j) continue;
        const std::complex<float> rounded(Complex(number(random), number(random)));
        const Complex value(rounded);
        rows[i].emplace_back(j, value);
        rows[j].emplace_back(i, std::conj(value));
        diagonal[i] += std::abs(value);
        diagonal[j] += std::abs(value);
      }
      right[i] = {number(random), number(random)};
    }
    offsets.push_back(0);
    for (const auto& row : rows) {
      for (const auto& [column, value] : row) {
        columns.push_back(column);
        values.emplace_back(value);
      }
      offsets.push_back(static_cast<Index>(columns.size()));
    }
  }

  [[nodiscard]] HermitianMatrix matrix() const { return {offsets, columns, values, diagonal}; }
  [[nodiscard]] std::vector<Complex> solution(double tolerance) const {
    std::vector<Complex> x(right.size());
    SolverOptions options;
    options.tolerance = tolerance;
    SolverVectors<Complex> vectors{.right = right};
    EXPECT_LT(solve(matrix(), options, x, vectors), options.max_iterations);
    return x;
  }

  std::vector<Index> offsets;
  std::vector<Index> columns;
  std::vector<std::complex<float>> values;
  std::vector<double> diagonal;
  std::vector<Complex> right;
};

TEST(ConjugateGradients, SolveTheSystem) {
  const Problem problem(60);
  Eigen::MatrixXcd dense = Eigen::MatrixXcd::Zero(60, 60);
  for (Index i = 0; i < 60; ++i) {
    dense(i, i) = problem.diagonal[i];
    for (Index at = problem.offsets[i]; at < problem.offsets[i + 1]; ++at) {
      dense(i, problem.columns[at]) += Complex(problem.values[at]);
    }
  }
  ASSERT_LT((dense - dense.adjoint()).norm(), 1e-14);
  const Eigen::VectorXcd exact =
      dense.fullPivLu().solve(Eigen::Map<const Eigen::VectorXcd>(problem.right.data(), 60));
  const std::vector<Complex> x = problem.solution(1e-12);
  // The error is at most the residual times the condition number, here below 1e3.
  const Eigen::Map<const Eigen::VectorXcd> found(x.data(), 60);
  EXPECT_LT((found - exact).norm(), 1e-9 * exact.norm());
}

TEST(ConjugateGradients, StopAtTheTolerance) {
  const Problem problem(20000);
  std::vector<Complex> loose(problem.right.size());
  std::vector<Complex> tight(problem.right.size());
  SolverVectors<Complex> vectors{.right = problem.right};
  const Index few = solve(problem.matrix(), {1e-2, 1000}, loose, vectors);
  vectors.right = problem.right;
  const Index many = solve(problem.matrix(), {1e-8, 1000}, tight, vectors);
  EXPECT_LT(few, many);
  vectors.right = problem.right;
  EXPECT_EQ(solve(problem.matrix(), {1e-2, 1000}, tight, vectors), 0) << "solved already";
}

TEST(ConjugateGradients, GiveTheSameBitsForAnyThreadCount) {
  const Problem problem(20000);
  std::vector<std::vector<Complex>> results;
  for (const std::size_t threads : {1, 2, 5}) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(problem.solution(1e-8));
  }
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

}  // namespace
}  // namespace strake
