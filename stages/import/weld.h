#pragma once

#include <cstdint>
#include <vector>

#include "common/core/disjoint_sets.h"
#include "stages/import/soup.h"

namespace strake::import {

/// Joins pieces along border edges whose end points coincide, and closes holes of no extent.
///
/// Only edges with a single face take part, so what is closed already stays as it is, also where it
/// touches itself; points that merely touch are not joined. The tolerance is 1e-9 of the diagonal,
/// or 1e-6 where more than half of all edges have one face only (an unwelded soup).
/// \return the half-edges of edges that have one face still, ascending
/// Cost O(F + B log B) for B border edges.
std::vector<Index> weld_borders(Soup& soup, double diagonal, Repairs& repairs);

/// The half-edges of edges with one face and two ends, ascending.
std::vector<Index> find_borders(const Soup& soup);

/// Of half-edges on borders those whose edge is not another one's, too, and has two ends,
/// ascending: what is left of borders after vertices were joined.
std::vector<Index> without_joined(const Soup& soup, const std::vector<Index>& border);

/// Replaces vertices by the lowest of those they are joined to.
/// \param farthest  grows by the largest distance to one of these, model units
/// \return vertices that went
std::int64_t rename_vertices(Soup& soup, DisjointSets& joined, double& farthest);

}  // namespace strake::import
