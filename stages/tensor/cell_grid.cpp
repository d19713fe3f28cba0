#include "stages/tensor/cell_grid.h"

#include <algorithm>
#include <cmath>

namespace strake {
namespace {

constexpr int kCorners = kCellsPerAxis + 1;
/// Of a cell; far more than positions lose when they are moved and scaled to the grid.
constexpr double kRounding = 1e-6;

Cell cell_at(int x, int y, int z) {
  return static_cast<Cell>(x | (y << kCellBits) | (z << (2 * kCellBits)));
}

std::size_t corner(int x, int y, int z) {
  return static_cast<std::size_t>((z * kCorners + y) * kCorners + x);
}

/// The cell whose position has the bits of the code in turn: x, y, z, x, ...
Cell morton_cell(std::uint32_t code) {
  CellPosition position = {0, 0, 0};
  for (int bit = 0; bit < 3 * kCellBits; ++bit) {
    position[bit % 3] |= static_cast<int>((code >> bit) & 1U) << (bit / 3);
  }
  return cell_at(position[0], position[1], position[2]);
}

}  // namespace

CellPosition position_of(Cell cell) {
  constexpr Cell kMask = kCellsPerAxis - 1;
  return {static_cast<int>(cell & kMask), static_cast<int>((cell >> kCellBits) & kMask),
          static_cast<int>(cell >> (2 * kCellBits))};
}

CellGrid::CellGrid(const Eigen::AlignedBox3d& box) : low_(box.min()) {
  const double longest = box.sizes().maxCoeff();
  per_length_ = longest > 0 ? kCellsPerAxis / longest : 0;
}

Cell CellGrid::cell_of(const Vec3& p) const {
  const auto along = [&](int axis) {
    return std::min(kCellsPerAxis - 1, static_cast<int>((p[axis] - low_[axis]) * per_length_));
  };
  return cell_at(along(0), along(1), along(2));
}

int CellGrid::reach(double length) const {
  const double cells = std::floor(length * per_length_ + kRounding) + 1;
  return static_cast<int>(std::min<double>(cells, kCellsPerAxis));
}

std::vector<std::uint8_t> cells_of_part(const std::vector<Index>& counts, Index parts, Index part) {
  std::int64_t total = 0;
  for (const Index count : counts) total += count;
  std::vector<std::uint8_t> marks(kCellCount, 0);
  std::int64_t before = 0;
  for (std::uint32_t code = 0; code < kCellCount; ++code) {
    const Cell cell = morton_cell(code);
    // Where the middle of the cell's own lies decides, so that large cells do not pile up behind.
    const std::int64_t twice_middle = 2 * before + counts[cell];
    before += counts[cell];
    if (counts[cell] > 0 && twice_middle * parts / (2 * total) == part) marks[cell] = 1;
  }
  return marks;
}

MarkedCells::MarkedCells(const std::vector<std::uint8_t>& marks)
    : sums_(static_cast<std::size_t>(kCorners) * kCorners * kCorners, 0) {
  for (int z = 0; z < kCellsPerAxis; ++z) {
    for (int y = 0; y < kCellsPerAxis; ++y) {
      Index row = 0;
      for (int x = 0; x < kCellsPerAxis; ++x) {
        row += marks[cell_at(x, y, z)];
        sums_[corner(x + 1, y + 1, z + 1)] = row + sums_[corner(x + 1, y, z + 1)] +
                                             sums_[corner(x + 1, y + 1, z)] -
                                             sums_[corner(x + 1, y, z)];
      }
    }
  }
}

bool MarkedCells::any_in(const CellPosition& low, const CellPosition& high) const {
  std::array<std::array<int, 3>, 2> end{};
  for (int axis = 0; axis < 3; ++axis) {
    end[0][axis] = std::max(low[axis], 0);
    end[1][axis] = std::min(high[axis], kCellsPerAxis - 1) + 1;
  }
  Index sum = 0;
  for (int at = 0; at < 8; ++at) {
    const int x = at & 1;
    const int y = (at >> 1) & 1;
    const int z = at >> 2;
    const int sign = (x + y + z) % 2 == 1 ? 1 : -1;
    sum += sign * sums_[corner(end[x][0], end[y][1], end[z][2])];
  }
  return sum > 0;
}

}  // namespace strake
