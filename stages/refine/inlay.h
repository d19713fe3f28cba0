#pragma once

#include <array>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "common/core/poly_mesh.h"
#include "common/geometry/cell_error/compared_surfaces.h"
#include "common/geometry/patch_fill/patch_outline.h"
#include "common/geometry/poly_topology/vertex_faces.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/surface_point.h"

namespace strake {

/// Faces of the input in place of a patch of cells, with bands of triangles around them.
struct Inlay {
  std::vector<Index> cells;  ///< of the result, that go; ascending
  /// Vertices of the result around them, path after path (patch_outline.h), with these to the left.
  std::vector<Index> outline;
  std::vector<SurfacePoint> points;  ///< of the input, for new vertices
  /// Corners below `outline.size()` are of the outline, the others of the points.
  std::vector<std::array<Index, 3>> faces;
};

/// Cuts inlays.
class InlayCutter {
 public:
  /// \param surfaces, quads  kept by reference; `surfaces` compares `quads`
  /// \param most_whole       cells of one component, at most, if an inlay takes the place of all
  InlayCutter(const ComparedSurfaces& surfaces, const QuadMesh& quads, std::size_t most_whole = 0);

  /// The input's faces over some cells, and over what these enclose.
  ///
  /// Faces larger than cells are divided. Over the cells lie those whose corners are all nearer to
  /// them than to the cells around, of cells that face the same way. The cells may reach the
  /// boundary, and go around handles and loops of the boundary. Over a whole component lies a whole
  /// component of the input.
  /// \param cells  of the result
  /// \return nothing where the faces over these cells are not connected in the same way
  [[nodiscard]] std::optional<Inlay> cut(const std::set<Index>& cells) const;

  /// Adds all cells with a vertex in common.
  void add_ring(std::set<Index>& cells) const;
  /// Adds the cells around a vertex of the result.
  void add_around(Index vertex, std::set<Index>& cells) const;

 private:
  struct Patch;
  class Cover;

  [[nodiscard]] std::optional<Patch> patch_of(std::set<Index> cells) const;
  [[nodiscard]] std::optional<Inlay> whole_component(std::vector<Index> cells) const;
  [[nodiscard]] Index neighbour(Index cell, Index a, Index b) const;
  [[nodiscard]] bool add_band(std::span<const Index> outer, std::span<const Index> inner,
                              bool is_closed, Inlay& inlay) const;
  [[nodiscard]] bool add_bands(const PatchOutline& outline, const PatchOutline& ring,
                               Inlay& inlay) const;

  const ComparedSurfaces& surfaces_;
  const QuadMesh& quads_;
  std::size_t most_whole_;
  SurfaceLines lines_;
  VertexFaces around_;  ///< of the result
};

}  // namespace strake
