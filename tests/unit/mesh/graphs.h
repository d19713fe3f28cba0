#pragma once

#include <gtest/gtest.h>

#include "common/core/tri_mesh.h"
#include "stages/mesh/overlay.h"

namespace strake {

/// What a graph of darts is as a surface, its cells taken for disks.
struct GraphCounts {
  Index nodes = 0;  ///< with an edge
  Index edges = 0;
  Index cells = 0;
  Index parts = 0;  ///< connected ones
  Index loose_ends = 0;

  /// Of the closed surface that the cells form: holes count as cells too.
  [[nodiscard]] Index euler() const { return nodes - edges + cells; }
};

GraphCounts count(const DartGraph& graph);

/// Whether next, prev, opposite and origins of all darts fit together.
::testing::AssertionResult is_consistent(const DartGraph& graph);

/// The darts that leave from(dart), counter-clockwise from `dart`.
std::vector<Index> darts_around(const DartGraph& graph, Index dart);

/// Cuts a mesh along lines, silently.
Overlay overlay_of(const TriMesh& mesh, const LineSet& lines = {});

/// The Euler characteristic of the surface with its holes closed by disks.
Index closed_euler(const TriMesh& mesh);

}  // namespace strake
