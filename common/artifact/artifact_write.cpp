#include "common/artifact/artifact_file.h"

namespace strake {
namespace {

/// \param data  the value, and its mesh where it belongs to one
template <class... Data>
bool write_as(ArtifactKind kind, const std::filesystem::path& path, const std::string& mesh_id,
              const Provenance& provenance, const Data&... data) {
  ArtifactWriter file(path, kind, mesh_id, provenance);
  write_data(data..., file);
  return file.commit();
}

template <class... Data>
std::string content_as(ArtifactKind kind, const std::string& mesh_id, const Data&... data) {
  ArtifactWriter nowhere(kind, mesh_id);
  write_data(data..., nowhere);
  return nowhere.content();
}

}  // namespace

bool write_artifact(const std::filesystem::path& path, const TriMesh& mesh,
                    const Provenance& provenance) {
  return write_as(ArtifactKind::mesh, path, mesh.id, provenance, mesh);
}
std::string content_of(const TriMesh& mesh) {
  return content_as(ArtifactKind::mesh, mesh.id, mesh);
}

bool write_artifact(const std::filesystem::path& path, const TensorField& field,
                    const TriMesh& mesh, const Provenance& provenance) {
  return write_as(ArtifactKind::tensor, path, field.mesh_id, provenance, field, mesh);
}
std::string content_of(const TensorField& field, const TriMesh& mesh) {
  return content_as(ArtifactKind::tensor, field.mesh_id, field, mesh);
}

bool write_artifact(const std::filesystem::path& path, const PrincipalField& field,
                    const TriMesh& mesh, const Provenance& provenance) {
  return write_as(ArtifactKind::field, path, field.mesh_id, provenance, field, mesh);
}
std::string content_of(const PrincipalField& field, const TriMesh& mesh) {
  return content_as(ArtifactKind::field, field.mesh_id, field, mesh);
}

bool write_artifact(const std::filesystem::path& path, const LineSet& lines, const TriMesh& mesh,
                    const Provenance& provenance) {
  return write_as(ArtifactKind::lines, path, lines.mesh_id, provenance, lines, mesh);
}
std::string content_of(const LineSet& lines, const TriMesh& mesh) {
  return content_as(ArtifactKind::lines, lines.mesh_id, lines, mesh);
}

bool write_artifact(const std::filesystem::path& path, const QuadMesh& quads,
                    const Provenance& provenance) {
  return write_as(ArtifactKind::quads, path, quads.mesh_id, provenance, quads);
}
std::string content_of(const QuadMesh& quads) {
  return content_as(ArtifactKind::quads, quads.mesh_id, quads);
}

bool write_artifact(const std::filesystem::path& path, const TensorPart& part,
                    const Provenance& provenance) {
  return write_as(ArtifactKind::tensor_part, path, part.mesh_id, provenance, part);
}
std::string content_of(const TensorPart& part) {
  return content_as(ArtifactKind::tensor_part, part.mesh_id, part);
}

bool write_artifact(const std::filesystem::path& path, const SizeField& size, const TriMesh& mesh,
                    const Provenance& provenance) {
  return write_as(ArtifactKind::size, path, size.mesh_id, provenance, size, mesh);
}
std::string content_of(const SizeField& size, const TriMesh& mesh) {
  return content_as(ArtifactKind::size, size.mesh_id, size, mesh);
}

}  // namespace strake
