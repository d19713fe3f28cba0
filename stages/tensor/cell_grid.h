#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "common/core/types.h"

/// Division of space: a cube of cells around a mesh, and runs of them that hold equal counts.
namespace strake {

inline constexpr int kCellBits = 7;
inline constexpr int kCellsPerAxis = 1 << kCellBits;
inline constexpr std::uint32_t kCellCount = 1U << (3 * kCellBits);

/// Number of a cell: kCellBits of x, of y and of z, x lowest.
using Cell = std::uint32_t;

/// Position of a cell along each axis, in [0, kCellsPerAxis).
using CellPosition = std::array<int, 3>;

CellPosition position_of(Cell cell);

/// The cells of the smallest cube that holds a box.
class CellGrid {
 public:
  explicit CellGrid(const Eigen::AlignedBox3d& box);

  /// The cell that holds p. \pre p is in the box
  [[nodiscard]] Cell cell_of(const Vec3& p) const;
  /// Cells along an axis by which two points no further apart than `length` can differ, at most;
  /// safe against rounding.
  [[nodiscard]] int reach(double length) const;

 private:
  Vec3 low_;
  double per_length_;  ///< cells per model unit
};

/// Cuts the cells in Morton order into `parts` runs of about equal counts, and gives one of them.
/// Every cell is in one run; runs are empty where there are more parts than cells in use.
/// \param counts  [kCellCount];
/// \param part  in [0, parts)
/// \return [kCellCount] 1 for the cells of that run
std::vector<std::uint8_t> cells_of_part(const std::vector<Index>& counts, Index parts, Index part);

/// Finds marked cells in boxes of cells in constant time (a summed-volume table, after Crow 1984).
class MarkedCells {
 public:
  /// \param marks  [kCellCount] 0 or 1
  explicit MarkedCells(const std::vector<std::uint8_t>& marks);
  /// Whether a cell from `low` to `high`, both included, is marked. Cells outside are not.
  [[nodiscard]] bool any_in(const CellPosition& low, const CellPosition& high) const;

 private:
  std::vector<Index> sums_;  ///< marks in the box of cells below each corner of the grid
};

}  // namespace strake
