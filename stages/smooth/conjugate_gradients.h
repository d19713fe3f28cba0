#pragma once

#include <complex>
#include <vector>

#include "common/core/types.h"

namespace strake {

/// A Hermitian, positive definite matrix in compressed rows, its real diagonal apart.
struct HermitianMatrix {
  const std::vector<Index>& offsets;         ///< [n + 1]
  const std::vector<Index>& columns;         ///< [E], without the diagonal
  std::vector<std::complex<double>> values;  ///< [E]
  std::vector<double> diagonal;              ///< [n], positive
};

struct SolverOptions {
  double tolerance = 1e-5;  ///< on the norm of the residual, as a share of that of the right side
  Index max_iterations = 2000;
};

/// Solves matrix * x = right by conjugate gradients with the diagonal as preconditioner.
///
/// Works in parallel. Sums are taken over blocks of a fixed size and added up in order, so the
/// result is the same for any number of threads (Eigen's solver is sequential).
/// \param x [n] first guess, then the solution
/// \return number of iterations
Index solve(const HermitianMatrix& matrix, const std::vector<std::complex<double>>& right,
            const SolverOptions& options, std::vector<std::complex<double>>& x);

}  // namespace strake
