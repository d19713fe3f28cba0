#pragma once

#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::import {

/// Takes the feature flags off what is no line but noise.
///
/// A line is a run of feature edges between nodes, or closed. On rough ground (mean roughness along
/// it above 2 degrees) it must be seen to have a course:
/// - it is no line where it is jagged: averaged over its length, its turn from edge to edge, as a
///   vector, changes by more than 2 x 15 degrees from one vertex to the next. The creases of a
///   machined or carved part run on smoothly however they bend, and a circle or regular polygon
///   turns evenly; what rough scans and coarse sampling leave runs to and fro.
/// - closed or with a loose end it needs 8 edges; fewer do not tell.
///
/// On smooth ground every line is one, except what runs around a single face, a speck.
///
/// Then loose ends shorter than 2 % of the diagonal are cut off, and connected pieces with a total
/// length below that are dropped, except for simple closed lines and what reaches the boundary. At
/// last pieces of at most 40 edges go whose bends cancel to 0.3 of their sizes, where those of the
/// edges around them do so to 0.35, are a degree or more in the mean, and few are flat: lumps of
/// noise. Larger ones go where the mean is 15 degrees or more; and where the mesh is rough as a
/// whole (`Noise::is_much`) 0.9 and 0.5 are enough.
///
/// Where lines of a component were noise and more than a tenth of its edges went, or any where a
/// tenth of all did, frayed pieces of it go as well: more than a corner in 20 edges and in 10 % of
/// the diagonal, amid edges that are bent by a degree in the mean.
/// \param mesh       corners are found anew
/// \param roughness  [3F] of feature edges, as `find_features` has it, radians
/// \return edges whose flag was taken
Index drop_noise(TriMesh& mesh, const std::vector<float>& roughness);

/// Takes the flags off connected pieces with a total length below `length`, model units.
/// \return edges whose flag was taken
Index drop_shorter(TriMesh& mesh, double length);

/// Takes the flags off connected pieces but those all of whose ends, two or more, lie on other
/// lines.
/// \param degree  [V] number of edges of the other lines
/// \return edges whose flag was taken
Index drop_loose(TriMesh& mesh, const std::vector<Index>& degree);

}  // namespace strake::import
