#pragma once

#include <vector>

#include "common/core/mesh_blocks.h"
#include "common/core/observer.h"
#include "common/core/tri_mesh.h"

namespace strake {

/// What one part of a mesh and its surroundings are made of.
struct PartMesh {
  /// Some faces of the whole mesh, with their vertices, in the same order. Edges to faces that were
  /// left out have no twin. Wedges 0 ... n - 1 are those of the part; the last one, n, stands for
  /// all corners of others. Only positions, faces, twins, features and wedges are filled in.
  TriMesh mesh;
  std::vector<Index> wedge;  ///< [n] of the whole mesh, ascending
  std::vector<Index> face;   ///< [F] of the whole mesh, ascending
};

/// Reads one part of a mesh that is too large to be held: the wedges in one of `parts` runs of
/// cells in space, with about equal numbers of them, and all that `estimate_wedge_tensors` reads.
/// \param part   in [0, parts)
/// \param reach  largest radius of a ball, model units
/// \throw InputError where wedges and faces contradict each other
/// Reads the mesh several times in blocks, and once more for each ring of slivers that leads out of
/// what is kept. Memory: what is kept, and 4 bytes per vertex of the mesh.
PartMesh read_part(const MeshBlocks& blocks, Index parts, Index part, double reach,
                   Observer& observer);

}  // namespace strake
