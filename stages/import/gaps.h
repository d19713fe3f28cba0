#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "stages/import/soup.h"

/// What tells gaps between borders from what is meant to be open.
namespace strake::import {

/// Shares of the diagonal: what is apart by less coincides; what coordinates in single precision
/// are off by; the widest gap that is sewn.
constexpr double kCoincident = 1e-9;
constexpr double kRounding = 1e-6;
constexpr double kWidest = 2e-4;
/// A gap over the shortest edge at its ends, at most: edges keep their ends apart, and their order.
constexpr double kGapOverEdge = 0.2;
/// How many times as far away any other edge must be, as where a third sheet meets.
constexpr double kClear = 3;
/// Cosine of 20 degrees: faces bent more sharply lie on top of each other.
constexpr double kOnTop = 0.94;

/// The direction from an edge into its face, across the edge; zero where the face has no height.
Vec3 inward(const Soup& soup, Index h);

/// The height of a face over its edge; not a number where that has no length.
double height_over(const Soup& soup, Index h);

/// The shortest edge at each vertex of the border; infinite elsewhere. [V]
std::vector<double> shortest_edges(const Soup& soup, const std::vector<Index>& border);

/// Two edges of borders, or parts of them, side by side.
struct EdgePair {
  std::array<Index, 2> first;   ///< ends of one
  std::array<Index, 2> second;  ///< of the other, each beside that of the first
  double gap = 0;               ///< the larger of the distances of the ends
  bool is_open = false;         ///< the borders leave room between them, along the surface
};

EdgePair edge_pair(const Soup& soup, const std::array<Index, 2>& first,
                   const std::array<Index, 2>& second);

/// Whether the faces of two border edges side by side lie on top of each other, apart by more than
/// rounding; tells, too, whether the pair is open.
bool lie_on_top(const Soup& soup, Index h, Index other, double diagonal, EdgePair& pair);

/// Pairs one after the other, with a vertex each in common at both sides.
/// \return [pairs] the first pair of the chain
std::vector<Index> find_chains(const std::vector<EdgePair>& pairs);

/// Chains that are slits: open all along, somewhere by more than 0.002 % of the diagonal, and do
/// not touch but at their ends.
/// \return [pairs]
std::vector<std::uint8_t> find_slits(const Soup& soup, const std::vector<EdgePair>& pairs,
                                     const std::vector<Index>& chain, double diagonal);

}  // namespace strake::import
