#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "common/core/edge_list.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct ImportOptions {
  double feature_angle_deg = 40;  ///< edges bent by more are features, from half of it on alone;
                                  ///< 180: none
  /// Height of ridges above which edges are feature edges whatever their angle; default: none
  std::optional<Length> feature_height = std::nullopt;
  /// Height above which edges between flat polygons are feature edges, too; default: none
  std::optional<Length> facet_height = std::nullopt;
  bool all_creases = false;                  ///< also those that look like noise
  std::string attribute_features = "seams";  ///< borders that are features: labels, seams, none
  bool no_attributes = false;                ///< leave out colours, texture coordinates and labels
  /// Largest share of the area that repairs may take away. Not counted is what is there twice.
  double most_removed_percent = 10;
  bool strict = false;  ///< refuse what would have to be repaired
  /// How far holes are across, at most, that are filled; default: none is
  std::optional<Length> fill_holes = std::nullopt;
  bool outwards = false;             ///< turn closed components that are inside out over
  std::int64_t denoise = 0;          ///< rounds in which noise is taken off
  Length longest_edge = percent(5);  ///< longer ones are divided, after all repairs

  OptionList declare();
};

struct ImportResult {
  TriMesh mesh;
  Report report;  ///< census, repairs with counts, feature graph
};

/// Turns a polygon soup into an oriented 2-manifold triangle mesh with its feature graph.
/// \throw InputError where no usable surface is left, or with `strict` where a repair is needed
/// \param listed  edges of `soup` that are features too; nullptr for none
ImportResult import_mesh(const PolyMesh& soup, const ImportOptions& options, Observer& observer,
                         const EdgeList* listed = nullptr);

}  // namespace strake
