#include "stages/smooth/hermitian_matrix.h"

namespace strake {
namespace {

using Complex = std::complex<double>;
using Vector = std::vector<Complex>;

Complex row_times(const HermitianMatrix& matrix, Index i, const Vector& x) {
  double real = matrix.diagonal[i] * x[i].real();
  double imag = matrix.diagonal[i] * x[i].imag();
  for (Index at = matrix.offsets[i]; at < matrix.offsets[i + 1]; ++at) {
    const Complex a(matrix.values[at]);
    const Complex& b = x[matrix.columns[at]];
    real += a.real() * b.real() - a.imag() * b.imag();
    imag += a.real() * b.imag() + a.imag() * b.real();
  }
  return {real, imag};
}

}  // namespace

Index solve(const HermitianMatrix& matrix, const SolverOptions& options, Vector& x,
            SolverVectors<Complex>& vectors) {
  return conjugate_gradients(
      options, [&matrix](Index i, const Vector& y) { return row_times(matrix, i, y); },
      [&matrix](Index i, const Complex& value) { return value / matrix.diagonal[i]; },
      [](const Complex& a, const Complex& b) { return a.real() * b.real() + a.imag() * b.imag(); },
      x, vectors);
}

}  // namespace strake
