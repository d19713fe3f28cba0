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

const std::vector<std::string> kStageOrder = {"import", "tensor", "smooth", "size",    "trace",
                                              "mesh",   "fit",    "refine", "evaluate"};

std::ptrdiff_t stage_place(const std::string& stage) {
  return std::find(kStageOrder.begin(), kStageOrder.end(), stage) - kStageOrder.begin();
}

[[noreturn]] void refuse(const fs::path& folder, const std::string& what) {
  throw InputError("folder '" + folder.string() + "' " + what);
}

/// The artifacts and reports of a folder.
class Folder {
 public:
  explicit Folder(fs::path path);

  /// The quads artifact that no other one was made from; of several the one that was judged, or
  /// that the last stage made.
  [[nodiscard]] const Found& result() const;
  /// The one of this kind that `result` goes back to, or the only one; nullptr: there is none.
  [[nodiscard]] const Found* source_of(const Found& result, ArtifactKind kind) const;
  /// Stage records that are about this result or what it was made from; of stages without a report
  /// what their artifacts say.
  [[nodiscard]] std::vector<Json> records(const Found& result) const;
  [[nodiscard]] const Json& seconds() const { return seconds_; }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  void read_json(const fs::path& file);
  void add_unreported(std::vector<Json>& records) const;
  /// Whether a report of the stage evaluate is about this artifact.
  [[nodiscard]] bool is_judged(const Found& found) const;

  fs::path path_;
  std::vector<Found> artifacts_;  // by name
  std::vector<Json> records_;
  Json seconds_;
};

Folder::Folder(fs::path path) : path_(std::move(path)) {
  std::error_code error;
  if (!fs::is_directory(path_, error)) {
    refuse(path_, "is not there; give one that 'strake remesh --keep FOLDER' made");
  }
  std::set<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path_)) files.insert(entry.path());
  for (const fs::path& file : files) {
    if (file.extension() == ".hdf") artifacts_.push_back({file, read_artifact_info(file)});
    if (file.extension() == ".json") read_json(file);
  }
}

void Folder::read_json(const fs::path& file) {
  Json json = Json::parse(read_text(file), nullptr, false);
  if (json.is_discarded()) throw InputError(file.string() + ": is no JSON; write it again");
  if (!json.is_object()) return;
  if (json.contains("stage") && json.contains("result")) {
    records_.push_back(std::move(json));
  } else if (file.filename() == "times.json" && json.contains("seconds")) {
    seconds_ = json["seconds"];
  }
}

bool Folder::is_judged(const Found& found) const {
  return std::any_of(records_.begin(), records_.end(), [&](const Json& record) {
    return record.value("/inputs/candidate"_json_pointer, "") == found.info.content;
  });
}

const Found& Folder::result() const {
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
    refuse(path_,
           "holds no artifact of kind 'quads', so there is no result to show; make one with "
           "'strake remesh MODEL -o OUT --keep FOLDER'");
  }
  if (rival != nullptr) {
    refuse(path_, "holds several results, " + best->path.filename().string() + " and " +
                      rival->path.filename().string() + "; give each a folder of its own");
  }
  return *best;
}

const Found* Folder::source_of(const Found& result, ArtifactKind kind) const {
  std::map<std::string, const Found*> by_content;
  std::vector<const Found*> of_kind;
  for (const Found& found : artifacts_) {
    by_content.emplace(found.info.content, &found);
    if (found.info.kind == kind) of_kind.push_back(&found);
  }
  if (of_kind.size() <= 1) return of_kind.empty() ? nullptr : of_kind.front();
  std::vector<const Found*> open = {&result};
  std::set<const Found*> seen;
  while (!open.empty()) {
    const Found* found = open.back();
    open.pop_back();
    if (!seen.insert(found).second) continue;
    if (found->info.kind == kind) return found;
    for (const auto& input : found->info.provenance.inputs) {
      const auto source = by_content.find(input.digest);
      if (source != by_content.end()) open.push_back(source->second);
    }
  }
  refuse(path_, "holds several artifacts of kind '" + kind_name(kind) + "', and " +
                    result.path.filename().string() +
                    " was made from none of them; keep one of them there");
}

void Folder::add_unreported(std::vector<Json>& records) const {
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

std::vector<Json> Folder::records(const Found& result) const {
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

}  // namespace

RunFiles read_run(const fs::path& path) {
  const Folder folder(path);
  const Found& result = folder.result();
  const Found* mesh = folder.source_of(result, ArtifactKind::mesh);
  if (mesh == nullptr) {
    refuse(path,
           "holds no artifact of kind 'mesh', which the result is compared with; make it with "
           "'strake-import MODEL -o FOLDER/mesh.hdf'");
  }
  RunFiles run;
  run.name = fs::absolute(path / ".").lexically_normal().parent_path().filename().string();
  run.mesh = read_tri_mesh(mesh->path);
  run.quads = read_fitting<QuadMesh>(PortKind::quads, result, run.mesh, mesh->path);
  if (const Found* field = folder.source_of(result, ArtifactKind::field)) {
    run.field = read_fitting<PrincipalField>(PortKind::field, *field, run.mesh, mesh->path);
    run.field_content = field->info.content;
  } else {
    run.missing.push_back(
        "The folder holds no artifact of kind 'field': curvature, directions, confidence and "
        "alignment are left out.");
  }
  if (const Found* lines = folder.source_of(result, ArtifactKind::lines)) {
    run.lines = read_fitting<LineSet>(PortKind::lines, *lines, run.mesh, mesh->path);
  } else {
    run.missing.push_back("The folder holds no artifact of kind 'lines': lines are left out.");
  }
  run.stages = folder.records(result);
  run.seconds = folder.seconds();
  const auto is_evaluation = [](const Json& record) { return record["stage"] == "evaluate"; };
  if (std::none_of(run.stages.begin(), run.stages.end(), is_evaluation)) {
    run.missing.push_back(
        "The folder holds no report of the stage evaluate on this result: its figures are left "
        "out.");
  }
  return run;
}

}  // namespace strake::report
