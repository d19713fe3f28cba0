#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "common/core/poly_mesh.h"
#include "common/core/types.h"
#include "common/geometry/poly_topology/poly_edges.h"
#include "common/geometry/topology/closed_components.h"

namespace strake {

/// How often a defect occurs at vertices or faces, and the least index where it does.
struct ElementDefect {
  Index count = 0;
  Index first = kNone;
};

/// How often a defect occurs at edges, and the first such edge: its vertices and one of its faces.
struct EdgeDefect {
  Index count = 0;
  std::array<Index, 2> vertices = {kNone, kNone};
  Index face = kNone;
};

/// What a polygon mesh is as a surface, from its indices alone.
struct PolyTopology {
  Index used_vertices = 0;  ///< that a face names
  Index unused_vertices = 0;
  Index faces = 0;
  Index edges = 0;
  Index components = 0;       ///< of faces, connected over edges
  Index boundary_edges = 0;   ///< with one face
  Index boundary_loops = 0;   ///< runs of boundary edges, one after the other around one fan
  std::int64_t euler = 0;     ///< used vertices - edges + faces
  bool is_orientable = true;  ///< whether faces can be turned so that no edge is misoriented
  /// Handles, summed over the components; empty unless the mesh is an oriented manifold.
  std::optional<std::int64_t> genus;

  Index triangles = 0;
  Index quads = 0;
  Index pentagons = 0;
  Index larger_faces = 0;  ///< with more than 5 sides
  Index most_sides = 0;

  EdgeDefect nonmanifold_edges;        ///< with more than two faces
  EdgeDefect misoriented_edges;        ///< both faces run the same way
  ElementDefect nonmanifold_vertices;  ///< with several fans of faces, or on a non-manifold edge
  ElementDefect repeated_corners;      ///< faces that name a vertex twice
  ElementDefect small_faces;           ///< with fewer than 3 corners

  /// No defect above; one or two oppositely oriented faces at every edge, one fan at every vertex.
  [[nodiscard]] bool is_oriented_manifold() const;
  /// A sentence on each kind of defect with its count and first place; "" where there is none.
  [[nodiscard]] std::string defects() const;
};

/// Examines the connectivity of a mesh; positions are not looked at.
/// \throw PreconditionError where a corner is no vertex of the mesh
/// Cost O(C) for bounded valence, for C corners in all.
PolyTopology analyse(const PolyMesh& mesh);

/// As above, with the mesh's edges at hand.
PolyTopology analyse(const PolyMesh& mesh, const PolyEdges& edges);

/// Which way the closed ones of its components look. As components, those connected over edges.
ClosedComponents judge_closed_components(const PolyMesh& mesh);

}  // namespace strake
