#include "strake/chain/session.h"

#include <chrono>
#include <utility>

namespace strake {

void Session::provide(const std::string& port, Value value, const std::string& origin,
                      const std::string& digest) {
  values_[port] = {std::make_shared<Value>(std::move(value)), origin, digest};
}

void Session::provide_as(const std::string& port, Value value, const std::string& source) {
  Entry& entry = values_.at(source);
  const std::string& digest = digest_of(entry);
  provide(port, std::move(value), entry.origin, digest);
}

StageRecord& Session::record_of(const Stage& stage) {
  for (StageRecord& record : records_) {
    if (record.provenance.stage == stage.name) return record;
  }
  return records_.emplace_back();
}

void Session::take_run(const Stage& stage, const Session& other) {
  take_from(other, {stage.output.name});
  for (const StageRecord& record : other.records_) {
    if (record.provenance.stage == stage.name) record_of(stage) = record;
  }
  seconds_.try_emplace(stage.name, other.seconds_.at(stage.name));
}

const TriMesh* Session::mesh_of(const Value& value) const {
  const std::string id = mesh_id_of(value);
  for (const auto& [port, entry] : values_) {
    const auto* mesh = entry.value ? std::get_if<TriMesh>(entry.value.get()) : nullptr;
    if (mesh != nullptr && mesh->id == id) return mesh;
  }
  return nullptr;
}

const std::string& Session::digest_of(Entry& entry) const {
  if (entry.digest.empty() && digester_ && entry.value) {
    entry.digest = digester_(*entry.value, mesh_of(*entry.value));
  }
  return entry.digest;
}

void Session::note_inputs(const Stage& stage, Provenance& provenance) {
  for (const Port& port : stage.inputs) {
    const auto entry = values_.find(port.name);
    if (entry == values_.end()) continue;
    const std::string& digest = digest_of(entry->second);
    if (!digest.empty()) provenance.inputs.push_back({port.name, digest});
  }
}

void Session::say_warnings(const std::string& stage, const Report& report) {
  for (const std::string& warning : report.warnings()) {
    const std::string text = stage + ": warning: " + warning;
    if (warned_of_->insert(text).second) say(text);
  }
}

void Session::say_held(const Stage& stage) {
  for (const StageRecord& record : records_) {
    if (record.provenance.stage == stage.name) say_warnings(stage.name, record.report);
  }
}

const Report& Session::run(const Stage& stage, const std::string& last_use_of) {
  observer_->begin(stage.name);
  Provenance provenance = provenance_of(stage);
  note_inputs(stage, provenance);  // before the stage, which may use some up
  Inputs inputs;
  for (const Port& port : stage.inputs) {
    const auto entry = values_.find(port.name);
    if (entry == values_.end()) continue;
    std::shared_ptr<Value>& value = entry->second.value;
    inputs.add(port.name,
               {port.name == last_use_of ? std::move(value) : value, entry->second.origin});
  }
  const auto begin = std::chrono::steady_clock::now();
  StageResult result = run_stage(stage, inputs, *observer_);
  seconds_[stage.name] +=
      std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (!held_.contains(stage.name)) say_warnings(stage.name, result.report);
  if (result.output) provide(stage.output.name, std::move(*result.output), stage.output.name, "");
  StageRecord& record = record_of(stage);
  record = {std::move(provenance), std::move(result.report)};
  return record.report;
}

void Session::keep(const Stage& stage) {
  if (!keeper_) return;
  const StageRecord& record = record_of(stage);
  const auto entry = values_.find(stage.output.name);
  const Value* output = entry == values_.end() ? nullptr : entry->second.value.get();
  const TriMesh* mesh = output == nullptr ? nullptr : mesh_of(*output);
  const std::string digest = keeper_({stage, record, output, mesh, seconds_});
  if (output != nullptr) entry->second.digest = digest;
}

}  // namespace strake
