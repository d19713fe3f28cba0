#include <OpenMesh/Core/IO/MeshIO.hh>
#include <OpenMesh/Tools/Decimater/DecimaterT.hh>
#include <OpenMesh/Tools/Decimater/ModNormalFlippingT.hh>
#include <OpenMesh/Tools/Decimater/ModQuadricT.hh>

#include "tests/bench/decimate/decimate.h"
#include "tests/bench/decimate/read_mesh.h"

namespace strake::bench {

std::size_t decimate_by_quadrics(const std::string& input, const std::string& output,
                                 std::size_t vertices) {
  Mesh mesh = read_mesh(input);
  mesh.delete_isolated_vertices();
  mesh.garbage_collection();
  OpenMesh::Decimater::DecimaterT<Mesh> decimater(mesh);
  OpenMesh::Decimater::ModQuadricT<Mesh>::Handle quadrics;
  decimater.add(quadrics);
  decimater.module(quadrics).unset_max_err();  // a priority, not a limit
  OpenMesh::Decimater::ModNormalFlippingT<Mesh>::Handle flipping;
  decimater.add(flipping);  // else flats fold over, where every collapse costs nothing
  decimater.initialize();
  decimater.decimate_to(vertices);
  mesh.garbage_collection();
  if (!OpenMesh::IO::write_mesh(mesh, output, OpenMesh::IO::Options::Default, 12)) {
    throw DecimationError("OpenMesh cannot write '" + output + "'");
  }
  return mesh.n_vertices();
}

}  // namespace strake::bench
