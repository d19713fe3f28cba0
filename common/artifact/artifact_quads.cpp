#include <array>
#include <cstddef>
#include <limits>

#include "common/artifact/artifact_attributes.h"
#include "common/artifact/artifact_file.h"

namespace strake {

void write_data(const QuadMesh& quads, ArtifactWriter& file) {
  const PolyMesh& mesh = quads.mesh;
  std::vector<std::uint8_t> types;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const std::size_t sides = mesh.face(f).size();
    types.push_back(sides == 3 ? kVtkTriangle : sides == 4 ? kVtkQuad : kVtkPolygon);
  }
  file.grid(mesh.positions, mesh.corners, mesh.offsets, types);
  file.adopt("Points", "positions");
  file.adopt("Offsets", "offsets");
  file.adopt("Connectivity", "corners");
  file.own("source_face", quads.provenance.face);
  file.own("source_barycentric", quads.provenance.barycentric);
  file.own("source_lines", quads.provenance.lines);
  for (const char* name : {"source_face", "source_barycentric", "source_lines"}) {
    file.show(name, std::string("PointData/") + name);
  }
  write_attributes(mesh.attributes, file);
}

QuadMesh read_quad_mesh(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::quads);
  QuadMesh quads;
  quads.mesh_id = file.mesh_id();
  quads.mesh.positions = file.own<Vec3>("positions");
  quads.mesh.offsets = file.own<Index>("offsets");
  quads.mesh.corners = file.own<Index>("corners");
  quads.provenance.face = file.own<Index>("source_face");
  quads.provenance.barycentric = file.own<std::array<double, 3>>("source_barycentric");
  quads.provenance.lines = file.own<std::array<Index, 2>>("source_lines");

  const std::size_t vertices = quads.mesh.positions.size();
  constexpr auto kAnyIndex = static_cast<std::size_t>(std::numeric_limits<Index>::max());
  file.require_offsets(quads.mesh.offsets, quads.mesh.corners.size(), 3, "offsets");
  file.require_finite(quads.mesh.positions, "positions");
  file.require_indices(quads.mesh.corners, 0, vertices, "corners");
  file.require_rows(quads.provenance.face, vertices, "source_face");
  file.require_rows(quads.provenance.barycentric, vertices, "source_barycentric");
  file.require_rows(quads.provenance.lines, vertices, "source_lines");
  file.require_indices(quads.provenance.face, 0, kAnyIndex, "source_face");
  file.require_indices(quads.provenance.lines, kNone, kAnyIndex, "source_lines");
  file.require_finite(quads.provenance.barycentric, "source_barycentric");
  quads.mesh.attributes =
      read_attributes(file, vertices, quads.mesh.corners.size(), quads.mesh.offsets.size() - 1);
  return quads;
}

}  // namespace strake
