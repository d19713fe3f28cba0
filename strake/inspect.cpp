#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/App.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/artifact/artifact.h"
#include "common/artifact/digest.h"
#include "common/core/error.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/topology/topology.h"
#include "strake/commands.h"
#include "strake/relations.h"

namespace strake {
namespace {

void print_artifact(const std::string& path) {
  const ArtifactInfo info = read_artifact_info(path);
  fmt::print("{}: strake artifact\n", path);
  fmt::print("  kind       {}, format {}\n", kind_name(info.kind), info.format_version);
  fmt::print("  mesh       {}\n", info.mesh_id);
  fmt::print("  digest     {}\n", digest_file(path));
  fmt::print("  content    {}\n", info.content);
  fmt::print("  made by    {}, version {}\n", info.provenance.stage, info.provenance.stage_version);
  for (const auto& option : info.provenance.options) {
    fmt::print("    --{} {}{}\n", option.name, option.value.empty() ? "(none)" : option.value,
               option.is_default ? "  (default)" : "");
  }
  for (const auto& input : info.provenance.inputs) {
    fmt::print("    from {} {}\n", input.role, input.digest);
  }
  fmt::print("  data\n");
  for (const auto& dataset : info.datasets) {
    fmt::print("    {:<28} {} x {} {}\n", dataset.name, dataset.rows, dataset.columns,
               dataset.type);
  }
}

void print_topology(const PolyTopology& topology) {
  fmt::print("  vertices   {}{}\n", topology.used_vertices,
             topology.unused_vertices > 0
                 ? fmt::format(", and {} that no face uses", topology.unused_vertices)
                 : "");
  fmt::print("  faces      {}: {} triangles, {} quads, {} pentagons, {} larger\n", topology.faces,
             topology.triangles, topology.quads, topology.pentagons, topology.larger_faces);
  fmt::print("  edges      {}, {} on the boundary\n", topology.edges, topology.boundary_edges);
  fmt::print("  components {}, boundary loops {}", topology.components, topology.boundary_loops);
  if (topology.genus) fmt::print(", genus {}", *topology.genus);
  fmt::print("\n");
  if (topology.is_oriented_manifold()) {
    fmt::print("  surface    oriented manifold, {}\n",
               topology.boundary_edges == 0 ? "closed" : "with boundary");
  } else {
    fmt::print("  defects    {}\n", topology.defects());
  }
}

/// Only where there is something to say: that closed surfaces look outwards goes without saying.
void print_orientation(const PolyMesh& mesh, const PolyTopology& topology) {
  const ClosedComponents closed = judge_closed_components(mesh);
  if (closed.inside_out == 0 && closed.cavities == 0) return;
  fmt::print("  inside out {} of {} components", closed.inside_out, topology.components);
  if (closed.cavities > 0) fmt::print(", and {} that are cavities of others", closed.cavities);
  fmt::print("\n");
}

std::string name_of(const FaceLabels& labels) {
  const std::set<Index> values(labels.of_face.begin(), labels.of_face.end());
  return fmt::format("{} ({})", labels.name, values.size());
}

void print_size_and_attributes(const PolyMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : mesh.positions) box.extend(p);
  if (!box.isEmpty()) {
    const Vec3 size = box.sizes();
    fmt::print("  size       {:.6g} x {:.6g} x {:.6g}\n", size.x(), size.y(), size.z());
  }
  std::vector<std::string> kinds;
  if (!mesh.attributes.colour.empty()) kinds.emplace_back("vertex colours");
  if (!mesh.attributes.texture.empty()) kinds.emplace_back("texture coordinates");
  for (const FaceLabels& labels : mesh.attributes.labels) {
    kinds.push_back("labels " + name_of(labels));
  }
  if (!kinds.empty()) fmt::print("  carries    {}\n", fmt::join(kinds, ", "));
}

int print_info(const std::string& path) {
  if (is_artifact(path)) {
    print_artifact(path);
    return 0;
  }
  ReadReport read;
  const PolyMesh mesh = read_mesh(path, read);
  fmt::print("{}: mesh file, {}\n", path, read.format);
  for (const std::string& warning : read.warnings()) fmt::print("  warning    {}\n", warning);
  const PolyTopology topology = analyse(mesh);
  print_topology(topology);
  print_orientation(mesh, topology);
  print_size_and_attributes(mesh);
  return 0;
}

PortKind port_kind(ArtifactKind kind) {
  switch (kind) {
    case ArtifactKind::mesh:
      return PortKind::mesh;
    case ArtifactKind::tensor:
      return PortKind::tensor;
    case ArtifactKind::field:
      return PortKind::field;
    case ArtifactKind::lines:
      return PortKind::lines;
    case ArtifactKind::quads:
      return PortKind::quads;
    case ArtifactKind::tensor_part:
      return PortKind::tensor_part;
    case ArtifactKind::size:
      return PortKind::size;
  }
  throw Error(ExitCode::internal, "an artifact of no kind");
}

bool is_mesh_artifact(const std::string& path) {
  try {
    return is_artifact(path) && read_artifact_info(path).kind == ArtifactKind::mesh;
  } catch (const InputError&) {
    return false;  // told of when it is checked
  }
}

/// Reads all of an artifact as a stage would.
/// \param meshes  paths by mesh id, undamaged: what fields hold can be told with their mesh only
/// \throw InputError  where it is damaged, or not what others name as theirs
void check_artifact(const ArtifactInfo& info, const std::string& path,
                    const std::map<std::string, std::string>& meshes) {
  const Value value = load_value(port_kind(info.kind), path);
  const auto changed = [&](const std::string& what) {
    throw InputError("'" + path + "' has another content than its " + what +
                     " says: it was changed after it was made; make it again");
  };
  const auto* mesh = std::get_if<TriMesh>(&value);
  if (mesh != nullptr && content_id(*mesh) != mesh->id) changed("mesh_id");
  std::optional<TriMesh> own;
  if (const auto found = meshes.find(info.mesh_id); mesh == nullptr && found != meshes.end()) {
    own = read_tri_mesh(found->second);
  }
  const std::string content = content_of(value, own ? &*own : nullptr);
  if (info.says_content && !content.empty() && content != info.content)
    changed("attribute 'content'");
}

/// \param meshes  undamaged ones before it, paths by mesh id; another one is added
void check_file(const std::string& path, std::int64_t max_sides,
                std::map<std::string, std::string>& meshes) {
  if (path.ends_with(".yaml") || path.ends_with(".yml")) {
    throw UsageError("'" + path + "' is a pipeline file; 'strake status --verify --file " + path +
                     "' checks what the store holds of it");
  }
  if (is_artifact(path)) {
    const ArtifactInfo info = read_artifact_info(path);
    check_artifact(info, path, meshes);
    check_picture(path);
    if (info.kind == ArtifactKind::mesh) meshes.emplace(info.mesh_id, path);
    if (info.kind != ArtifactKind::quads) {
      fmt::print("{}: sound {} artifact\n", path, kind_name(info.kind));
      return;
    }
  }
  const Value value = load_value(PortKind::polygons, path);
  const auto& polygons = std::get<Polygons>(value);
  const PolyTopology topology = analyse(polygons.mesh);
  fmt::print("{}\n", path);
  print_topology(topology);
  std::string faults = topology.defects();
  for (const std::string& warning : polygons.read.warnings()) faults += " " + warning;
  if (max_sides > 0 && topology.most_sides > max_sides) {
    faults += fmt::format(" A face has {} sides, {} are allowed.", topology.most_sides, max_sides);
  }
  if (!faults.empty()) throw AlgorithmError(path + " is not sound: " + faults);
}

/// Checks all files, so that one that is damaged does not hide others, and then whether those that
/// are sound belong together.
int check_files(std::vector<std::string> paths, std::int64_t max_sides) {
  std::stable_partition(paths.begin(), paths.end(), is_mesh_artifact);
  std::vector<std::string> sound;
  std::map<std::string, std::string> meshes;
  std::string complaints;
  ExitCode code = ExitCode::precondition;
  for (const std::string& path : paths) {
    try {
      check_file(path, max_sides, meshes);
      sound.push_back(path);
    } catch (const Interrupted&) {
      throw;
    } catch (const Error& error) {
      if (complaints.empty()) code = error.code();
      complaints += (complaints.empty() ? "" : "\n") + std::string(error.what());
    }
  }
  for (const BrokenRelation& broken : broken_relations(sound)) {
    complaints += (complaints.empty() ? "" : "\n") + broken.text;
  }
  if (!complaints.empty()) throw Error(code, complaints);
  return 0;
}

}  // namespace

void add_info_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("info", "Say what a mesh file or an artifact holds.");
  command->footer("Examples:\n  strake info scan.ply\n  strake info work/field.hdf");
  const auto path = std::make_shared<std::string>();
  command->add_option("file", *path, "mesh file or artifact")->type_name("FILE")->required();
  command->callback([path, &chosen] { chosen = [path] { return print_info(*path); }; });
}

void add_check_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("check",
                                         "Check that artifacts are undamaged and made from each "
                                         "other, and meshes oriented manifolds.");
  command->footer("Examples:\n  strake check quads.obj\n  strake check scan.ply work/*.hdf");
  const auto paths = std::make_shared<std::vector<std::string>>();
  const auto max_sides = std::make_shared<std::int64_t>(0);
  command->add_option("files", *paths, "mesh files and artifacts")->type_name("FILE")->required();
  add_options(*command, {{.name = "max-sides",
                          .target = max_sides.get(),
                          .unit = "",
                          .help = "Largest number of sides a face may have; 0 allows any.",
                          .min = 0,
                          .max = 1e6}});
  command->callback([paths, max_sides, &chosen] {
    chosen = [paths, max_sides] { return check_files(*paths, *max_sides); };
  });
}

}  // namespace strake
