#include "strake/report/run_files.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/stage/value.h"

namespace strake::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// An artifact of the folder.
struct Found {
  fs::path path;
  ArtifactInfo info;
};

const std::vector<std::string> kStageOrder = {
    "import",  "coarsen",  "tensor", "smooth", "size",           "trace",        "mesh",    "lift",
    "prolong", "decimate", "fit",    "refine", "refine-uncross", "refine-worst", "evaluate"};

std::ptrdiff_t stage_place(const std::string& stage) {
  return std::find(kStageOrder.begin(), kStageOrder.end(), stage) - kStageOrder.begin();
}

/// The files of a folder by name.
std::vector<fs::path> files_in(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw InputError("folder '" + folder.string() +
                     "' is not there; give one that 'strake remesh --keep FOLDER' made");
  }
  const fs::directory_iterator entries(folder, error);
  if (error) {
    throw InputError("folder '" + folder.string() + "' cannot be read: " + error.message() +
                     "; check its rights");
  }
  std::vector<fs::path> files;
  for (const auto& entry : entries) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

/// Whether this is what a stage reports, and not a file of something else.
bool is_record(const Json& json) {
  const auto has = [&](const char* member, Json::value_t type) {
    return json.contains(member) && json[member].type() == type;
  };
  using Type = Json::value_t;
  return has("stage", Type::string) && has("options", Type::object) &&
         has("inputs", Type::object) && has("result", Type::object) && has("warnings", Type::array);
}

/// The artifacts and reports of a run.
class Sources {
 public:
  /// \param place  where they are, for messages: "folder 'run'"
  Sources(std::string place, const std::vector<fs::path>& files);

  /// The quads artifact that no other one was made from; of several the one that was judged, or
  /// that the last stage made.
  [[nodiscard]] const Found& result() const;
  /// The one of this kind that `result` goes back to, or the only one; nullptr: there is none.
  /// \param mesh_id  of the mesh that it belongs to; "": of any
  [[nodiscard]] const Found* source_of(const Found& result, ArtifactKind kind,
                                       const std::string& mesh_id = "") const;
  /// The same, of the mesh of the result where there is one.
  [[nodiscard]] const Found* source_beside(const Found& result, ArtifactKind kind) const {
    const Found* own = source_of(result, kind, result.info.mesh_id);
    return own != nullptr ? own : source_of(result, kind);
  }
  /// Stage records that are about this result or what it was made from; of stages without a report
  /// what their artifacts say.
  [[nodiscard]] std::vector<Json> records(const Found& result) const;
  [[nodiscard]] const Json& seconds() const { return seconds_; }
  [[noreturn]] void refuse(const std::string& what) const { throw InputError(place_ + " " + what); }

 private:
  void read_json(const fs::path& file);
  void add_unreported(std::vector<Json>& records) const;
  /// Whether a report of the stage evaluate is about this artifact.
  [[nodiscard]] bool is_judged(const Found& found) const;

  std::string place_;
  std::vector<Found> artifacts_;
  std::vector<Json> records_;
  Json seconds_;
};

Sources::Sources(std::string place, const std::vector<fs::path>& files) : place_(std::move(place)) {
  for (const fs::path& file : files) {
    if (file.extension() == ".hdf") artifacts_.push_back({file, read_artifact_info(file)});
    if (file.extension() == ".json") read_json(file);
  }
}

void Sources::read_json(const fs::path& file) {
  Json json = Json::parse(read_text(file), nullptr, false);
  if (json.is_discarded()) throw InputError(file.string() + ": is no JSON; write it again");
  if (!json.is_object()) return;
  if (is_record(json)) {
    records_.push_back(std::move(json));
  } else if (file.filename() == "times.json" && json.contains("seconds")) {
    seconds_ = json["seconds"];
  }
}

bool Sources::is_judged(const Found& found) const {
  return std::any_of(records_.begin(), records_.end(), [&](const Json& record) {
    return record.value("/inputs/candidate"_json_pointer, "") == found.info.content;
  });
}

const Found& Sources::result() const {
  std::set<std::string> used;
  for (const Found& found : artifacts_) {
    if (found.info.kind != ArtifactKind::quads) continue;
    for (const auto& input : found.info.provenance.inputs) {
      if (input.digest != found.info.content) used.insert(input.digest);
    }
  }
  // What was judged comes first, then what the later stage made: between rounds of a tolerance no
  // file is kept, so that a result need not name the one it comes from.
  const auto rank = [&](const Found& found) {
    return std::pair(is_judged(found), stage_place(found.info.provenance.stage));
  };
  const Found* best = nullptr;
  const Found* rival = nullptr;
  for (const Found& found : artifacts_) {
    if (found.info.kind != ArtifactKind::quads || used.contains(found.info.content)) continue;
    if (best == nullptr || rank(found) > rank(*best)) {
      best = &found;
      rival = nullptr;
    } else if (rank(found) == rank(*best) && found.info.content != best->info.content) {
      rival = &found;
    }
  }
  if (best == nullptr) {
    refuse(
        "holds no artifact of kind 'quads', so there is no result to show; make one with "
        "'strake remesh MODEL -o OUT --keep FOLDER'");
  }
  if (rival != nullptr) {
    refuse("holds several results, " + best->path.filename().string() + " and " +
           rival->path.filename().string() + "; give each a folder of its own");
  }
  return *best;
}

const Found* Sources::source_of(const Found& result, ArtifactKind kind,
                                const std::string& mesh_id) const {
  const auto is_asked_for = [&](const Found& found) {
    return found.info.kind == kind && (mesh_id.empty() || found.info.mesh_id == mesh_id);
  };
  std::map<std::string, const Found*> by_content;
  std::vector<const Found*> of_kind;
  for (const Found& found : artifacts_) {
    by_content.emplace(found.info.content, &found);
    if (is_asked_for(found)) of_kind.push_back(&found);
  }
  if (of_kind.size() <= 1) return of_kind.empty() ? nullptr : of_kind.front();
  std::vector<const Found*> open = {&result};
  std::set<const Found*> seen;
  while (!open.empty()) {
    const Found* found = open.back();
    open.pop_back();
    if (!seen.insert(found).second) continue;
    if (is_asked_for(*found)) return found;
    for (const auto& input : found->info.provenance.inputs) {
      const auto source = by_content.find(input.digest);
      if (source != by_content.end()) open.push_back(source->second);
    }
  }
  refuse("holds several artifacts of kind '" + kind_name(kind) + "', and " +
         result.path.filename().string() + " was made from none of them; keep one of them there");
}

void Sources::add_unreported(std::vector<Json>& records) const {
  for (const Found& found : artifacts_) {
    const Provenance& provenance = found.info.provenance;
    const auto is_known = [&](const Json& record) { return record["stage"] == provenance.stage; };
    if (std::any_of(records.begin(), records.end(), is_known)) continue;
    Json record = Json::parse(provenance.to_json());
    record["result"] = Json::object();
    record["warnings"] = Json::array();
    records.push_back(std::move(record));
  }
}

std::vector<Json> Sources::records(const Found& result) const {
  std::vector<Json> mine;
  for (const Json& record : records_) {
    const std::string judged = record.value("/inputs/candidate"_json_pointer, result.info.content);
    if (judged == result.info.content) mine.push_back(record);
  }
  add_unreported(mine);
  std::stable_sort(mine.begin(), mine.end(), [](const Json& a, const Json& b) {
    return stage_place(a["stage"]) < stage_place(b["stage"]);
  });
  return mine;
}

/// Reads an artifact and checks that it fits the mesh.
template <class T>
T read_fitting(PortKind kind, const Found& found, const TriMesh& mesh, const fs::path& mesh_path) {
  Value value = load_value(kind, found.path);
  check_belongs(mesh, mesh_path.string(), value, found.path.string());
  return std::get<T>(std::move(value));
}

/// Puts together what the sources hold.
RunFiles read_sources(std::string name, const Sources& sources, Json seconds) {
  const Found& result = sources.result();
  const Found* mesh = sources.source_beside(result, ArtifactKind::mesh);
  if (mesh == nullptr) {
    sources.refuse(
        "holds no artifact of kind 'mesh', which the result is compared with; make it with "
        "'strake-import MODEL -o FOLDER/mesh.hdf'");
  }
  RunFiles run;
  run.name = std::move(name);
  run.mesh = read_tri_mesh(mesh->path);
  run.quads = read_fitting<QuadMesh>(PortKind::quads, result, run.mesh, mesh->path);
  if (const Found* field = sources.source_beside(result, ArtifactKind::field)) {
    run.field = read_fitting<PrincipalField>(PortKind::field, *field, run.mesh, mesh->path);
    run.field_content = field->info.content;
  } else {
    run.missing.push_back(
        "There is no artifact of kind 'field': curvature, directions, confidence and "
        "alignment are left out.");
  }
  if (const Found* lines = sources.source_of(result, ArtifactKind::lines)) {
    const Found* under = sources.source_of(result, ArtifactKind::mesh, lines->info.mesh_id);
    if (under != nullptr && under != mesh) run.coarse = read_tri_mesh(under->path);
    run.lines = read_fitting<LineSet>(PortKind::lines, *lines, run.line_mesh(),
                                      under != nullptr ? under->path : mesh->path);
  } else {
    run.missing.push_back("There is no artifact of kind 'lines': lines are left out.");
  }
  run.stages = sources.records(result);
  run.seconds = seconds.is_null() ? sources.seconds() : std::move(seconds);
  const auto is_evaluation = [](const Json& record) { return record["stage"] == "evaluate"; };
  if (std::none_of(run.stages.begin(), run.stages.end(), is_evaluation)) {
    run.missing.push_back(
        "There is no report of the stage evaluate on this result: its figures are left "
        "out.");
  }
  return run;
}

}  // namespace

RunFiles read_run(const fs::path& path) {
  return read_sources(fs::absolute(path / ".").lexically_normal().parent_path().filename().string(),
                      Sources("folder '" + path.string() + "'", files_in(path)), nullptr);
}

RunFiles read_run(const std::string& name, const std::vector<fs::path>& files,
                  nlohmann::ordered_json seconds) {
  return read_sources(name, Sources("run '" + name + "'", files), std::move(seconds));
}

}  // namespace strake::report
