#pragma once

#include <complex>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/conjugate_gradients.h"

/// The linear system of the cross field, whose unknowns are complex numbers, and its solution.
namespace strake {

/// A Hermitian, positive definite matrix in compressed rows, its real diagonal apart.
struct HermitianMatrix {
  const std::vector<Index>& offsets;  ///< [n + 1]
  const std::vector<Index>& columns;  ///< [E], without the diagonal
  /// [E] in single precision: reading them is most of the time that a product takes.
  std::vector<std::complex<float>> values;
  std::vector<double> diagonal;  ///< [n], positive
};

/// Solves matrix * x = right by `conjugate_gradients` with the diagonal as preconditioner.
/// \param x        [n] first guess, then the solution
/// \param vectors  the right side, the rest of any content
/// \return number of iterations
Index solve(const HermitianMatrix& matrix, const SolverOptions& options,
            std::vector<std::complex<double>>& x, SolverVectors<std::complex<double>>& vectors);

}  // namespace strake
