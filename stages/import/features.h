#pragma once

#include <limits>

#include "common/core/tri_mesh.h"
#include "stages/import/listed_edges.h"

namespace strake::import {

/// Which edges are features.
struct FeatureRules {
  double angle_deg = 40;     ///< in [0, 180]; bent by more are creases; 180: no creases
  bool all_creases = false;  ///< those that look like noise, too
  /// Model units; edges that stand out by more are ridges
  double height = std::numeric_limits<double>::infinity();
  /// The same of edges between facets
  double facet_height = std::numeric_limits<double>::infinity();
  bool labels = true;  ///< borders of labels
  bool seams = true;   ///< seams of texture coordinates
};

struct FeatureCounts {
  Index strong_edges = 0;      ///< bent by more than the angle
  Index shallow_edges = 0;     ///< bent by more than half the angle, standing alone
  Index bridging_edges = 0;    ///< bent less, added between strong ones
  Index dropped_edges = 0;     ///< of creases that look like noise
  double dropped_length = 0;   ///< of these, model units
  double dropped_share = 0;    ///< and as a share of all creases
  Index ridge_edges = 0;       ///< bent less than creases, but standing out by more than the height
  Index facet_edges = 0;       ///< of flat polygons, as `find_facet_edges` states
  Index label_edges = 0;       ///< between faces of different labels
  Index open_label_edges = 0;  ///< likewise, but no features, as the rules do not want them
  Index open_seam_edges = 0;   ///< the same of seams
  Index seam_edges = 0;  ///< where the sides differ in texture coordinates, or these turn back, and
                         ///< not in labels
  Index listed_edges = 0;  ///< of a list, the boundary excluded
  Index edges = 0;         ///< in the end
  Index corners = 0;
  Index sharp_points = 0;  ///< corners off all lines, as `find_sharp_points` states
};

/// Flags feature edges (`is_feature`) and the nodes of feature and boundary lines (`is_corner`).
///
/// An edge is a crease where its faces' normals differ by more than `angle_deg`, and by more than
/// that by thrice the roughness there: what the median bend of the edges around it (those bent by
/// at most `angle_deg`, without the spokes of a tip, five or more that are bent alike) exceeds 5
/// degrees by. So noise and detail at the limit of the sampling are
/// no creases, and on smooth faces the angle decides alone. Where there is no roughness, edges bent
/// by more than half of `angle_deg` are creases, too, if they stand alone (`stands_alone`) and make
/// lines of 5 % of the diagonal, or lie across a strip between features or boundaries in the end
/// (`lies_across`), as the toe of a rib does. Creases that fade out are continued along edges bent
/// by more than 0.6 of `angle_deg` (and the roughness), but only as far as another crease or the
/// boundary.
///
/// What is noise then is dropped, as `drop_noise` states, unless all creases are wanted. The normal
/// of a sliver, which rounding of the coordinates may have turned, is taken from the neighbour
/// across a long edge.
///
/// A ridge is an edge that stands out by more than `height` over the straight way across its two
/// faces, from corner to corner in their section: a mesh that is coarser than the distances that
/// matter is taken as the polyhedron it is.
///
/// Edges of facets are those of `find_facet_edges` that stand out by more than `facet_height`, and
/// all of them where that is half of their length or more.
///
/// Borders of labels, seams, lines at which texture coordinates turn back, and listed edges are
/// features whatever their shape; none of this applies to them.
///
/// Corners are the vertices where other than two feature or boundary edges meet, or where such a
/// line turns by more than 50 degrees, measured over 1 % of the diagonal on each side (along a
/// boundary at least three mean edges, ten where it is ragged, at most a twelfth of a closed line
/// or a boundary) and only where it turns most. Closed boundaries shorter than 4 % of the diagonal
/// have no corners by turning. Tips of cones are corners without lines, where there are creases at
/// all.
///
/// \param listed  edges that are features too; nullptr for none
/// \pre build_topology has run
FeatureCounts find_features(TriMesh& mesh, const FeatureRules& rules, const ListedEdges* listed);

}  // namespace strake::import
