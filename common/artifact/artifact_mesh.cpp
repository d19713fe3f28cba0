#include <Eigen/Geometry>
#include <array>
#include <cstddef>
#include <limits>

#include "common/artifact/artifact_attributes.h"
#include "common/artifact/artifact_file.h"

namespace strake {
namespace {

/// Whether the connections say what the faces say; needed before anyone walks along them.
void require_connected(const TriMesh& mesh, const ArtifactReader& file) {
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Index twin = mesh.twin[h];
    if (twin != kNone) {
      file.require(mesh.twin[twin] == h && twin != h && mesh.from(twin) == mesh.to(h) &&
                       mesh.to(twin) == mesh.from(h),
                   "twin", "contradicts the faces");
      file.require(mesh.is_feature[h] == mesh.is_feature[twin], "is_feature",
                   "differs on the two sides of an edge");
    }
    file.require(mesh.from(h) != mesh.to(h), "faces", "holds a face that repeats a corner");
    file.require(mesh.wedge_vertex[mesh.wedge_of(h)] == mesh.from(h), "face_wedges",
                 "contradicts the faces");
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    file.require(mesh.from(mesh.vertex_out[v]) == v, "vertex_out", "contradicts the faces");
  }
}

/// Whether the diagonal may be that of the mesh, or of a finer one of which it has some vertices:
/// lengths are shares of it.
void require_diagonal(double diagonal, const std::vector<Vec3>& positions,
                      const ArtifactReader& file) {
  constexpr double kFactor = 100;
  Eigen::AlignedBox3d box;
  for (const Vec3& p : positions) box.extend(p);
  const double own = box.diagonal().norm();
  file.require(diagonal > 0 && own < kFactor * diagonal && diagonal < kFactor * own, "diagonal",
               "is not that of the box around the positions");
}

}  // namespace

void write_data(const TriMesh& mesh, ArtifactWriter& file) {
  std::vector<Index> offsets;
  for (Index f = 0; f <= mesh.face_count(); ++f) offsets.push_back(3 * f);
  file.grid(mesh.positions, mesh.faces, offsets,
            std::vector<std::uint8_t>(mesh.faces.size(), kVtkTriangle));
  file.adopt("Points", "positions");
  file.adopt("Connectivity", "faces");
  file.own("twin", mesh.twin);
  file.own("vertex_out", mesh.vertex_out);
  file.own("is_feature", mesh.is_feature);
  file.own("is_corner", mesh.is_corner);
  file.own("face_wedges", mesh.face_wedges);
  file.own("wedge_vertex", mesh.wedge_vertex);
  file.own("source_vertex", mesh.source_vertex);
  file.own("source_face", mesh.source_face);
  if (!mesh.parent_wedge.empty()) {
    file.own("parent_wedge", mesh.parent_wedge);
    file.own("parent_id", std::vector<std::uint8_t>(mesh.parent_id.begin(), mesh.parent_id.end()));
  }
  file.own("origin", std::vector<Vec3>{mesh.origin});
  file.own("diagonal", std::vector<double>{mesh.diagonal});
  file.show("is_corner", "PointData/is_corner");
  file.show("source_vertex", "PointData/source_vertex");
  file.show("source_face", "CellData/source_face");
  write_attributes(mesh.attributes, file);
}

TriMesh read_tri_mesh(const std::filesystem::path& path) {
  const ArtifactReader file(path, ArtifactKind::mesh);
  TriMesh mesh;
  mesh.id = file.mesh_id();
  mesh.positions = file.own<Vec3>("positions");
  mesh.faces = file.own<std::array<Index, 3>>("faces", hdf5::Layout::flat);
  mesh.twin = file.own<Index>("twin");
  mesh.vertex_out = file.own<Index>("vertex_out");
  mesh.is_feature = file.own<std::uint8_t>("is_feature");
  mesh.is_corner = file.own<std::uint8_t>("is_corner");
  mesh.face_wedges = file.own<std::array<Index, 3>>("face_wedges");
  mesh.wedge_vertex = file.own<Index>("wedge_vertex");
  mesh.source_vertex = file.own<Index>("source_vertex");
  mesh.source_face = file.own<Index>("source_face");
  const auto origin = file.own<Vec3>("origin");
  const auto diagonal = file.own<double>("diagonal");

  const std::size_t vertices = mesh.positions.size();
  const std::size_t faces = mesh.faces.size();
  const std::size_t wedges = mesh.wedge_vertex.size();
  constexpr std::size_t kAnyIndex = std::numeric_limits<Index>::max();
  file.require(faces > 0, "faces", "is empty");
  for (const auto& [name, rows] :
       {std::pair{"positions", vertices}, {"faces", faces}, {"wedge_vertex", wedges}}) {
    file.require(rows <= kAnyIndex / 3, name, "claims an impossible size");
  }
  file.require_rows(mesh.twin, 3 * faces, "twin");
  file.require_rows(mesh.vertex_out, vertices, "vertex_out");
  file.require_rows(mesh.is_feature, 3 * faces, "is_feature");
  file.require_rows(mesh.is_corner, vertices, "is_corner");
  file.require_rows(mesh.face_wedges, faces, "face_wedges");
  file.require_rows(mesh.source_vertex, vertices, "source_vertex");
  file.require_rows(mesh.source_face, faces, "source_face");
  file.require_rows(origin, 1, "origin");
  file.require_rows(diagonal, 1, "diagonal");

  file.require_finite(mesh.positions, "positions");
  file.require_finite(origin, "origin");
  file.require_finite(diagonal, "diagonal");
  require_diagonal(diagonal.front(), mesh.positions, file);
  file.require_indices(mesh.faces, 0, vertices, "faces");
  file.require_indices(mesh.twin, kNone, 3 * faces, "twin");
  file.require_indices(mesh.vertex_out, 0, 3 * faces, "vertex_out");
  file.require_indices(mesh.face_wedges, 0, wedges, "face_wedges");
  file.require_indices(mesh.wedge_vertex, 0, vertices, "wedge_vertex");
  file.require_indices(mesh.source_vertex, kNone, kAnyIndex, "source_vertex");
  file.require_indices(mesh.source_face, kNone, kAnyIndex, "source_face");
  file.require_codes(mesh.is_feature, 2, "is_feature");
  file.require_codes(mesh.is_corner, 2, "is_corner");
  require_connected(mesh, file);

  if (file.has("parent_wedge")) {
    mesh.parent_wedge = file.own<Index>("parent_wedge");
    file.require_rows(mesh.parent_wedge, wedges, "parent_wedge");
    file.require_indices(mesh.parent_wedge, 0, kAnyIndex, "parent_wedge");
    const auto id = file.own<std::uint8_t>("parent_id");
    mesh.parent_id.assign(id.begin(), id.end());
  }
  mesh.attributes = read_attributes(file, vertices, 3 * faces, faces);
  mesh.origin = origin.front();
  mesh.diagonal = diagonal.front();
  return mesh;
}

}  // namespace strake
