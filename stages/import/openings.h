#pragma once

#include <cstdint>
#include <string>

#include "common/core/tri_mesh.h"
#include "stages/import/soup.h"

namespace strake::import {

/// How open a surface is, and into how many pieces it falls.
struct Openness {
  Index boundary_edges = 0;
  Index components = 0;  ///< of faces, connected over edges
};

/// Of triangles with any number of faces at an edge. Cost O(F log F).
Openness openness(const Soup& soup);

/// \pre build_topology has run
Openness openness(const TriMesh& mesh);

/// A warning where repairs left more boundary edges or components than there were; "" elsewhere.
std::string describe_openings(const Openness& before, const Openness& after);

}  // namespace strake::import
