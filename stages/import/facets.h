#pragma once

#include <vector>

#include "common/core/tri_mesh.h"
#include "common/geometry/angles.h"

namespace strake::import {

constexpr double kFlatBend = 1 * kDegree;  ///< largest bend within a facet, radians

/// The edges of a surface made of facets, flat polygons of two triangles or more: those between two
/// of them that are bent by more than 10 degrees. None where less than two thirds of what is bent
/// so much, by length and off features, lies between facets: triangulations of round shapes are
/// bent at every edge.
///
/// \param bend  [3F] radians
/// \return half-edges, one an edge, that are no features yet
std::vector<Index> find_facet_edges(const TriMesh& mesh, const std::vector<float>& bend);

}  // namespace strake::import
