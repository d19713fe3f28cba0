#pragma once

#include <memory>
#include <vector>

#include "common/geometry/cell_error/compared_surfaces.h"

namespace strake {

/// How far one face of a result and the surface are apart, both ways, and how the surface bends
/// away from it.
struct CellError {
  double rms = 0;      ///< model units, of the samples on the face and of those nearest to it
  double largest = 0;  ///< model units, of the same samples
  /// 1 / length, symmetric, in the plane of the face: the surface is x^T bend x away from a plane
  /// at x from the middle of the face, by least squares. Zero where the samples do not tell.
  Mat3 bend = Mat3::Zero();
};

/// What a result's distance to its surface is made of.
struct ErrorMap {
  std::vector<CellError> cells;    ///< [F of the result]
  std::vector<Index> vertex_cell;  ///< [V of the mesh] the face of the result nearest to the vertex
  double rms = 0;                  ///< model units, both ways
  double largest = 0;              ///< model units, both ways
};

/// How densely a result is measured.
struct CellSampling {
  int rows = 5;  ///< of samples on a triangle of the result: rows (rows + 1) / 2; positive
  double input_step = 0.2;  ///< from sample to sample on the input, in edges of a mean cell
};

/// Measures a result against its surface face by face.
///
/// Samples: a grid on every triangle of the result and on every face of the input, fine against the
/// cells, and all vertices of both. Deterministic for any thread count.
/// Cost O(samples log faces), parallel.
ErrorMap measure_cells(const ComparedSurfaces& surfaces, const CellSampling& sampling = {});

/// `measure_cells` for one result after another of the same input: what faces and samples have that
/// are as they were in the one before is not measured again.
class CellMeasure {
 public:
  explicit CellMeasure(const CellSampling& sampling = {});
  CellMeasure(const CellMeasure&) = delete;
  CellMeasure& operator=(const CellMeasure&) = delete;
  ~CellMeasure();

  /// \return as `measure_cells`, with the samples of the input that the first result had.
  /// \pre `surfaces` compares with the same input each time
  ErrorMap measure(const ComparedSurfaces& surfaces);

 private:
  struct Known;

  CellSampling sampling_;
  std::unique_ptr<Known> known_;
};

/// The member `bend` of one face's CellError alone.
Mat3 cell_bend(const ComparedSurfaces& surfaces, Index face);

}  // namespace strake
