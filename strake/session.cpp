#include "strake/session.h"

#include <chrono>
#include <utility>

#include "common/artifact/artifact.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"

namespace strake {

namespace fs = std::filesystem;

void Session::keep_in(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder)) {
    throw InputError("folder '" + folder.string() + "' cannot be made: " + error.message());
  }
  folder_ = folder;
}

void Session::provide(const std::string& port, Value value, const std::string& origin,
                      const std::string& digest) {
  values_[port] = {std::make_shared<const Value>(std::move(value)), origin, digest};
}

void Session::provide_as(const std::string& port, Value value, const std::string& source) {
  const Entry& entry = values_.at(source);
  provide(port, std::move(value), entry.origin, entry.digest);
}

StageRecord& Session::record_of(const Stage& stage) {
  for (StageRecord& record : records_) {
    if (record.provenance.stage == stage.name) return record;
  }
  return records_.emplace_back();
}

void Session::note_inputs(const Stage& stage, Provenance& provenance) const {
  provenance.inputs.clear();
  for (const Port& port : stage.inputs) {
    const auto entry = values_.find(port.name);
    if (entry == values_.end() || entry->second.digest.empty()) continue;
    provenance.inputs.push_back({port.name, entry->second.digest});
  }
}

const Report& Session::run(const Stage& stage) {
  console_->begin(stage.name);
  Inputs inputs;
  for (const Port& port : stage.inputs) {
    const auto entry = values_.find(port.name);
    if (entry != values_.end()) inputs.add(port.name, {entry->second.value, entry->second.origin});
  }
  const auto begin = std::chrono::steady_clock::now();
  StageResult result = run_stage(stage, inputs, *console_);
  seconds_[stage.name] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  for (const std::string& warning : result.report.warnings()) {
    console_->say(stage.name + ": warning: " + warning);
  }
  if (result.output) provide(stage.output.name, std::move(*result.output), stage.output.name, "");
  StageRecord& record = record_of(stage);
  record = {provenance_of(stage), std::move(result.report)};
  note_inputs(stage, record.provenance);
  return record.report;
}

void Session::keep(const Stage& stage) {
  if (folder_.empty()) return;
  StageRecord& record = record_of(stage);
  note_inputs(stage, record.provenance);
  if (stage.output.kind != PortKind::report) {
    const fs::path path = folder_ / (stage.output.name + ".hdf");
    Entry& entry = values_.at(stage.output.name);
    save_value(path, *entry.value, &get<TriMesh>("mesh"), record.provenance);
    entry.digest = content_digest(path);
  }
  write_text(folder_ / (stage.name + ".json"), record_json(record));
  write_text(folder_ / "times.json", times_json(seconds_));
}

}  // namespace strake
