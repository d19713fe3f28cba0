#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <vector>

#include "common/core/types.h"
#include "stages/refine/inlay.h"
#include "tests/support/result_cases.h"

namespace strake {

/// The height of a surface with small waves.
inline double terrain(double x, double y) { return 0.05 * std::sin(9 * x) * std::cos(7 * y); }

Vec3 area_vector(const std::vector<Vec3>& positions, const std::array<Index, 3>& t);

double area(const std::vector<Vec3>& positions, const std::vector<std::array<Index, 3>>& triangles);

/// Of the vertices of an inlay's faces.
std::vector<Vec3> positions_of(const Inlay& inlay, const ComparedSurfaces& surfaces);

/// A cell of a result of 8 x 8 and those around it.
std::set<Index> nine_cells(const InlayCutter& cutter);

/// Flat sheets, all but the last, each of cells x cells cells.
support::Case flat_sheets(std::size_t count, Index cells, const support::Height& last);

/// A case of n x n cells without some of them, and without the surface under some.
support::Case with_holes(const support::Case& whole, Index n, const std::set<Index>& cells,
                         const std::set<Index>& surface);

}  // namespace strake
