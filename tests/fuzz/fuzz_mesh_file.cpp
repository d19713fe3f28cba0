// Any bytes as a mesh file: a sound mesh, or an InputError.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/core/error.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  strake::ReadReport report;
  try {
    const strake::PolyMesh mesh =
        strake::parse_mesh({reinterpret_cast<const char*>(data), size}, "", report);
    for (strake::Index f = 0; f < mesh.face_count(); ++f) {
      if (mesh.face(f).size() < 3) std::abort();
      for (const strake::Index v : mesh.face(f)) {
        if (v < 0 || v >= mesh.vertex_count() || !mesh.positions[v].allFinite()) std::abort();
      }
    }
  } catch (const strake::InputError&) {  // refused
  }
  return 0;
}
