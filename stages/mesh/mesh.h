#pragma once

#include <optional>

#include "common/core/line_set.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct MeshOptions {
  std::int64_t max_sides = 5;      ///< of a face
  double odd_price = 1;            ///< what a face that is no quad costs; 0 leaves them
  double valence_price = 1;        ///< what an edge too many or too few at a vertex costs
  double corner_distance = 0.004;  ///< of merged corners from features, in wanted edge lengths
  bool pure_quads = false;         ///< make every face a quad
  std::optional<Length> border_distance = std::nullopt;  ///< of ragged boundaries from their course
  std::int64_t strip_vertices = 0;  ///< what strips are split or taken out for; 0 leaves them

  OptionList declare();
};

struct MeshResult {
  QuadMesh quads;
  Report report;
};

/// Builds the polygon mesh whose edges run along the lines.
///
/// Paper: [MK04] section 5. Differs: an arrangement on the surface, decided combinatorially,
/// instead of angles in space; so every cell closes and the topology of the input is kept by
/// construction.
/// \throw AlgorithmError where the result fails its own check
MeshResult mesh_lines(const TriMesh& mesh, const LineSet& lines, const MeshOptions& options,
                      Observer& observer);

}  // namespace strake
