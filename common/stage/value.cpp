#include "common/stage/value.h"

#include <algorithm>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/atomic_file.h"
#include "common/artifact/edge_list_file.h"
#include "common/artifact/meshfile/guide_reader.h"
#include "common/artifact/meshfile/mesh_writer.h"
#include "common/core/error.h"
#include "common/core/text.h"
#include "common/stage/invariants.h"
#include "common/stage/overloaded.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArtifactExtension = ".hdf";

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

Value read_value(PortKind kind, const fs::path& path) {
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
      return read_density(path);
    case PortKind::guides:
      return read_guides(path);
    case PortKind::report:
      break;
  }
  throw Error(ExitCode::internal, "reports are not read");
}

}  // namespace

Value load_value(PortKind kind, const fs::path& path) {
  Value value = read_value(kind, path);
  if (const std::string fault = broken_invariant(value); !fault.empty()) {
    throw InputError(path.string() + ": " + fault + "; the file is damaged, make it again");
  }
  return value;
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
            if (lower_case(path.extension().string()) == kArtifactExtension) {
              write_artifact(path, quads, provenance);
            } else {
              write_mesh(path, quads.mesh);
            }
          },
          [&](const auto& field) { write_artifact(path, field, *mesh, provenance); },
      },
      value);
}

std::string content_of(const Value& value, const TriMesh* mesh) {
  const auto none = [] { return std::string(); };
  return std::visit(
      Overloaded{
          [&](const Polygons&) { return none(); }, [&](const OpenedMesh&) { return none(); },
          [&](const EdgeList&) { return none(); }, [&](const DensityField&) { return none(); },
          [&](const GuideLines&) { return none(); },
          [](const TriMesh& own) { return content_of(own); },
          [](const TensorPart& part) { return content_of(part); },
          [](const QuadMesh& quads) { return content_of(quads); },
          [&](const auto& field) { return mesh == nullptr ? none() : content_of(field, *mesh); }},
      value);
}

const std::vector<std::string>& output_extensions(PortKind kind) {
  static const std::vector<std::string> kArtifact = {kArtifactExtension};
  static const std::vector<std::string> kReport = {".json"};
  static const std::vector<std::string> kPolygons = {".ply", ".obj", ".off"};
  static const std::vector<std::string> kQuads = {kArtifactExtension, ".obj", ".ply", ".off"};
  if (kind == PortKind::report) return kReport;
  if (kind == PortKind::polygons) return kPolygons;
  return kind == PortKind::quads ? kQuads : kArtifact;
}

std::string check_extension(PortKind kind, const fs::path& path) {
  const std::string extension = lower_case(path.extension().string());
  const std::vector<std::string>& allowed = output_extensions(kind);
  if (std::find(allowed.begin(), allowed.end(), extension) != allowed.end()) return {};
  return "'" + path.string() + "': the name must end in " + (allowed.size() > 1 ? "one of " : "") +
         join_words(allowed);
}

void check_output_path(PortKind kind, const fs::path& path) {
  const std::string fault = check_extension(kind, path);
  if (!fault.empty()) throw UsageError("output " + fault);
  check_place("output", path);
}

void check_place(const std::string& role, const fs::path& path) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) {
    throw UsageError(role + " '" + path.string() + "' is a folder; give a file name");
  }
  if (path.has_parent_path() && !fs::is_directory(path.parent_path(), ignored)) {
    throw InputError(role + " '" + path.string() + "': the folder '" + path.parent_path().string() +
                     "' does not exist; make it first");
  }
  const AtomicFile attempt(path);  // leaves nothing behind
}

}  // namespace strake
