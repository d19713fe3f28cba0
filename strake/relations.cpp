#include "strake/relations.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "common/artifact/artifact.h"
#include "strake/run/stage_catalog.h"

namespace strake {
namespace {

struct GivenFile {
  std::string path;
  std::string content;
  std::optional<ArtifactInfo> info;  ///< of an artifact
  std::string port;                  ///< of its maker, whose result it is; "" where none is known
};

GivenFile given_file(const std::string& path) {
  GivenFile file{path, content_digest(path), std::nullopt, ""};
  if (!is_artifact(path)) return file;
  file.info = read_artifact_info(path);
  const std::vector<std::string>& names = stage_names();
  const std::string& maker = file.info->provenance.stage;
  if (std::find(names.begin(), names.end(), maker) != names.end()) {
    file.port = make_stage(maker).output.name;
  }
  return file;
}

bool is_mesh(const GivenFile& file) { return file.info && file.info->kind == ArtifactKind::mesh; }

/// A mesh other than this file's, where none that is its own is given.
const GivenFile* strange_mesh(const GivenFile& file, const std::vector<GivenFile>& all) {
  const GivenFile* strange = nullptr;
  for (const GivenFile& other : all) {
    if (!is_mesh(other) || is_mesh(file)) continue;
    if (other.info->mesh_id == file.info->mesh_id) return nullptr;
    strange = &other;
  }
  return strange;
}

/// Whether the other one was made from this file, as a fit of what was refined, and so came later.
bool is_made_from(const GivenFile& other, const GivenFile& file) {
  const auto& inputs = other.info->provenance.inputs;
  return std::any_of(inputs.begin(), inputs.end(),
                     [&](const auto& input) { return input.digest == file.content; });
}

/// The file given for an input, where none is the one that was read.
const GivenFile* other_input(const GivenFile& file, const Provenance::InputRecord& input,
                             const std::vector<GivenFile>& all) {
  const std::string& maker = file.info->provenance.stage;
  const bool is_model = (maker == "import" || maker == "remesh") && input.role == "input";
  const GivenFile* found = nullptr;
  for (const GivenFile& other : all) {
    if (other.content == input.digest) return nullptr;
    const bool is_for_it =
        other.info ? other.port == input.role && &other != &file && !is_made_from(other, file) &&
                         (is_mesh(other) || other.info->mesh_id == file.info->mesh_id)
                   : is_model;
    if (is_for_it) found = &other;
  }
  return found;
}

}  // namespace

std::vector<BrokenRelation> broken_relations(const std::vector<std::string>& files) {
  std::vector<GivenFile> all;
  all.reserve(files.size());
  for (const std::string& path : files) all.push_back(given_file(path));
  std::vector<BrokenRelation> broken;
  for (const GivenFile& file : all) {
    if (!file.info) continue;
    const std::string& maker = file.info->provenance.stage;
    const std::string again =
        std::string("run strake") + (maker == "remesh" ? " " : "-") + maker + " again";
    if (const GivenFile* mesh = strange_mesh(file, all)) {
      broken.push_back(
          {file.path, mesh->path,
           fmt::format("{}: foreign: it belongs to another mesh than '{}'; {} on files of this "
                       "one, or take the mesh it was made with",
                       file.path, mesh->path, again)});
      continue;
    }
    for (const Provenance::InputRecord& input : file.info->provenance.inputs) {
      if (const GivenFile* other = other_input(file, input, all)) {
        broken.push_back({file.path, other->path,
                          fmt::format("{}: stale: made from another '{}' than '{}' is now; {}",
                                      file.path, input.role, other->path, again)});
      }
    }
  }
  return broken;
}

}  // namespace strake
