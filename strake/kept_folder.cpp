#include "strake/kept_folder.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <system_error>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "strake/relations.h"

namespace strake {
namespace fs = std::filesystem;

namespace {

/// The result and what it was made from, step by step.
/// \param files  artifacts to look among
std::set<std::string> origin_of(const std::string& result, const std::vector<std::string>& files) {
  std::map<std::string, std::string> made;  // by content
  for (const std::string& file : files) made.emplace(content_digest(file), file);
  std::set<std::string> origin;
  std::vector<std::string> queue;
  if (std::ranges::find(files, result) != files.end()) queue.push_back(result);
  while (!queue.empty()) {
    const std::string file = std::move(queue.back());
    queue.pop_back();
    if (!origin.insert(file).second) continue;
    for (const auto& input : read_artifact_info(file).provenance.inputs) {
      if (const auto found = made.find(input.digest); found != made.end()) {
        queue.push_back(found->second);
      }
    }
  }
  return origin;
}

}  // namespace

KeptFolder::KeptFolder(fs::path folder, std::vector<const Stage*> stages)
    : folder_(std::move(folder)), stages_(std::move(stages)) {}

std::vector<fs::path> KeptFolder::files() const {
  std::vector<fs::path> all;
  for (const Stage* stage : stages_) {
    all.push_back(folder_ / (stage->name + ".json"));
    all.push_back(folder_ / (stage->output.name + ".hdf"));
  }
  return all;
}

bool KeptFolder::is_kept() const {
  std::error_code ignored;
  if (!fs::is_regular_file(times(), ignored)) return false;
  const auto seconds = read_times(read_text(times()));
  return seconds && std::ranges::any_of(stages_, [&](const Stage* stage) {
           return seconds->contains(stage->name);
         });
}

void KeptFolder::check(const std::vector<NamedFile>& others) const {
  std::vector<fs::path> written = files();
  written.push_back(times());
  for (const NamedFile& other : others) {
    for (const fs::path& path : written) {
      if (other.path.empty() || !is_same_file(path.string(), other.path)) continue;
      throw UsageError(fmt::format("--keep '{}' would replace '{}', the {}; give another folder",
                                   folder_.string(), other.path, other.role));
    }
  }
  if (is_kept()) return;
  std::error_code ignored;
  for (const fs::path& path : written) {
    if (!fs::exists(path, ignored)) continue;
    throw UsageError(fmt::format(
        "folder '{}' has '{}' and is not that of a kept run; give a new folder, or that of one",
        folder_.string(), path.filename().string()));
  }
}

Session::Keeper KeptFolder::keeper() const {
  std::error_code error;
  fs::create_directories(folder_, error);
  std::error_code ignored;
  if (!fs::is_directory(folder_, ignored)) {
    throw InputError("folder '" + folder_.string() + "' cannot be made: " + error.message());
  }
  return [*this, has_begun = std::make_shared<bool>(false)](const Session::Kept& kept) {
    // First, as it tells that the others are of kept runs.
    write_text(times(), times_json(kept.seconds));
    if (!std::exchange(*has_begun, true)) {
      std::error_code left;
      for (const fs::path& path : files()) fs::remove(path, left);
    }
    write_text(folder_ / (kept.stage.name + ".json"), record_json(kept.record));
    if (kept.output == nullptr) return std::string();
    const fs::path path = folder_ / (kept.stage.output.name + ".hdf");
    save_value(path, *kept.output, kept.mesh, kept.record.provenance);
    return content_digest(path);
  };
}

void KeptFolder::end(const std::string& port) const {
  std::vector<std::string> kept;
  std::error_code ignored;
  for (const fs::path& path : files()) {
    if (path.extension() == ".hdf" && fs::exists(path, ignored)) kept.push_back(path.string());
  }
  const std::set<std::string> origin = origin_of((folder_ / (port + ".hdf")).string(), kept);
  const auto remove_one = [&] {
    for (const BrokenRelation& broken : broken_relations(kept)) {
      for (const std::string& path : {broken.file, broken.other}) {
        if (origin.contains(path)) continue;
        std::erase(kept, path);
        fs::remove(path);
        for (const Stage* stage : stages_) {
          if (stage->output.name != fs::path(path).stem()) continue;
          fs::remove(folder_ / (stage->name + ".json"));
        }
        return true;
      }
    }
    return false;
  };
  while (remove_one()) {
  }
}

}  // namespace strake
