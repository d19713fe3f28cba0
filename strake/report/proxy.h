#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "common/core/tri_mesh.h"

namespace strake::report {

/// The surface as it is drawn: its own vertices, perhaps not all of them.
struct Proxy {
  std::vector<Index> wedge;              ///< [N] wedge of the mesh that each vertex is
  std::vector<std::uint32_t> triangles;  ///< [3 T] of these vertices
  double deviation = 0;  ///< model units, as the decimation estimates it; 0: nothing is left out
};

/// Takes a mesh whole where it has at most `most_faces` faces; decimates it to about as many else.
///
/// Vertices are wedges, so that fields keep their jumps at creases, and are among those of the
/// mesh, so that fields need no interpolation. Order is for fast drawing and small files.
/// Cost O(F log F), one thread; deterministic.
Proxy make_proxy(const TriMesh& mesh, std::size_t most_faces);

}  // namespace strake::report
