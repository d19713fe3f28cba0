#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace strake {

/// A way to divide a polygon into quads by diagonals between its corners.
struct QuadDivision {
  /// Corners i < j; the parts that a diagonal leaves are divided by later ones.
  std::vector<std::pair<std::size_t, std::size_t>> diagonals;
  std::vector<std::array<std::size_t, 4>> quads;  ///< ascending corners
};

/// What a quad of four ascending corners costs; infinite: it must not be.
using QuadPrice = std::function<double(std::size_t, std::size_t, std::size_t, std::size_t)>;
/// What a diagonal between corners i < j costs; infinite: it must not be.
using DiagonalPrice = std::function<double(std::size_t, std::size_t)>;

/// The cheapest division of a polygon into quads, by dynamic programming over the diagonals.
/// \param corners  even, at least 4
/// \return nothing where every division has an infinite price. Cost O(n^4) for n corners, of which
///         there are about ten
std::optional<QuadDivision> cheapest_division(std::size_t corners, const QuadPrice& quad,
                                              const DiagonalPrice& diagonal);

}  // namespace strake
