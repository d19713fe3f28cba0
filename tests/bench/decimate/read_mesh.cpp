// The reader must come before the mesh, to which it adds its formats.
#include "tests/bench/decimate/read_mesh.h"

#include <OpenMesh/Core/IO/MeshIO.hh>

#include "tests/bench/decimate/decimate.h"

namespace strake::bench {

Mesh read_mesh(const std::string& input) {
  Mesh mesh;
  if (!OpenMesh::IO::read_mesh(mesh, input)) {
    throw DecimationError("OpenMesh cannot read '" + input + "'");
  }
  return mesh;
}

std::size_t read_only(const std::string& input) { return read_mesh(input).n_vertices(); }

}  // namespace strake::bench
