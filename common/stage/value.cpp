#include "common/stage/value.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/edge_list_file.h"
#include "common/artifact/meshfile/guide_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

template <class... Callables>
struct Overloaded : Callables... {
  using Callables::operator()...;
};
template <class... Callables>
Overloaded(Callables...) -> Overloaded<Callables...>;

constexpr const char* kArtifactExtension = ".hdf";

std::string lower_extension(const fs::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return extension;
}

Polygons load_polygons(const fs::path& path) {
  Polygons polygons;
  if (is_artifact(path)) {
    QuadMesh quads = read_quad_mesh(path);
    polygons.mesh = std::move(quads.mesh);
    polygons.mesh_id = std::move(quads.mesh_id);
  } else {
    polygons.mesh = read_mesh(path, polygons.read);
  }
  return polygons;
}

/// Whether every index that `lines` holds exists in `mesh`.
bool fits(const TriMesh& mesh, const LineSet& lines) {
  return lines.spacing_along_min.size() == mesh.wedge_vertex.size() &&
         std::all_of(
             lines.points.begin(), lines.points.end(),
             [&](const LinePoint& point) { return point.halfedge < mesh.halfedge_count(); }) &&
         std::all_of(lines.chord_face.begin(), lines.chord_face.end(),
                     [&](Index face) { return face < mesh.face_count(); });
}

bool fits(const TriMesh& mesh, const Value& value) {
  const std::size_t wedges = mesh.wedge_vertex.size();
  return std::visit(Overloaded{
                        [&](const TensorField& field) { return field.tensor.size() == wedges; },
                        [&](const PrincipalField& field) {
                          const auto& faces = field.guides.face;
                          return field.normal.size() == wedges &&
                                 field.face_confidence.size() == mesh.faces.size() &&
                                 std::all_of(faces.begin(), faces.end(),
                                             [&](Index face) { return face < mesh.face_count(); });
                        },
                        [&](const LineSet& lines) { return fits(mesh, lines); },
                        [&](const TensorPart& part) {
                          return part.wedge.empty() || part.wedge.back() < mesh.wedge_count();
                        },
                        [&](const QuadMesh& quads) {
                          const auto& faces = quads.provenance.face;
                          return std::all_of(faces.begin(), faces.end(),
                                             [&](Index face) { return face < mesh.face_count(); });
                        },
                        [&](const SizeField& size) { return size.along.size() == wedges; },
                        [](const auto&) { return true; },
                    },
                    value);
}

}  // namespace

Value load_value(PortKind kind, const fs::path& path) {
  switch (kind) {
    case PortKind::polygons:
      return load_polygons(path);
    case PortKind::mesh:
      return read_tri_mesh(path);
    case PortKind::tensor:
      return read_tensor_field(path);
    case PortKind::field:
      return read_principal_field(path);
    case PortKind::lines:
      return read_line_set(path);
    case PortKind::quads:
      return read_quad_mesh(path);
    case PortKind::opened_mesh:
      return open_tri_mesh(path);
    case PortKind::tensor_part:
      return read_tensor_part(path);
    case PortKind::edge_list:
      return read_edge_list(path);
    case PortKind::size:
      return read_size_field(path);
    case PortKind::density:
      return DensityField{"", read_density(path)};
    case PortKind::guides:
      return read_guides(path);
    case PortKind::report:
      break;
  }
  throw Error(ExitCode::internal, "reports are not read");
}

void save_value(const fs::path& path, const Value& value, const TriMesh* mesh,
                const Provenance& provenance) {
  std::visit(
      Overloaded{
          [&](const Polygons& polygons) { write_mesh(path, polygons.mesh); },
          [&](const TriMesh& own) { write_artifact(path, own, provenance); },
          [&](const TensorPart& part) { write_artifact(path, part, provenance); },
          [&](const OpenedMesh&) {
            throw Error(ExitCode::internal, "an opened mesh is not written");
          },
          [&](const EdgeList&) {
            throw Error(ExitCode::internal, "a list of edges is not written");
          },
          [&](const DensityField&) { throw Error(ExitCode::internal, "a density is not written"); },
          [&](const GuideLines&) { throw Error(ExitCode::internal, "guides are not written"); },
          [&](const QuadMesh& quads) {
            if (lower_extension(path) == kArtifactExtension) {
              write_artifact(path, quads, provenance);
            } else {
              write_mesh(path, quads.mesh);
            }
          },
          [&](const auto& field) { write_artifact(path, field, *mesh, provenance); },
      },
      value);
}

void check_output_path(PortKind kind, const fs::path& path) {
  const std::string extension = lower_extension(path);
  std::vector<std::string> allowed = {kArtifactExtension};
  if (kind == PortKind::report) allowed = {".json"};
  if (kind == PortKind::polygons) allowed = {".obj", ".ply", ".off"};
  if (kind == PortKind::quads) allowed = {".obj", ".ply", ".off", kArtifactExtension};
  if (std::find(allowed.begin(), allowed.end(), extension) == allowed.end()) {
    std::string list;
    for (const std::string& item : allowed) list += (list.empty() ? "" : ", ") + item;
    throw UsageError("output '" + path.string() + "': the name must end in " +
                     (allowed.size() > 1 ? "one of " : "") + list);
  }
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw UsageError("output '" + path.string() + "' is a folder; give a file name");
  }
  if (path.has_parent_path() && !fs::is_directory(path.parent_path(), ignored)) {
    throw InputError("output '" + path.string() + "': the folder '" + path.parent_path().string() +
                     "' does not exist; make it first");
  }
}

std::string mesh_id_of(const Value& value) {
  return std::visit(Overloaded{[](const TriMesh& mesh) { return mesh.id; },
                               [](const OpenedMesh& mesh) { return mesh->header().id; },
                               [](const EdgeList&) { return std::string(); },
                               [](const GuideLines&) { return std::string(); },
                               [](const auto& other) { return other.mesh_id; }},
                    value);
}

void check_belongs(const TriMesh& mesh, const std::string& mesh_name, const Value& value,
                   const std::string& name) {
  const std::string id = mesh_id_of(value);
  if (id.empty() &&
      (std::holds_alternative<Polygons>(value) || std::holds_alternative<DensityField>(value) ||
       std::holds_alternative<GuideLines>(value))) {
    return;
  }
  if (id != mesh.id) {
    throw PreconditionError("'" + name + "' belongs to another mesh than '" + mesh_name + "' (" +
                            id + ", not " + mesh.id +
                            "); give the mesh it was made from, or make it again");
  }
  if (!fits(mesh, value)) {
    throw InputError("'" + name + "' names elements that '" + mesh_name +
                     "' does not have; the file is damaged, make it again");
  }
}

}  // namespace strake
