#include "strake/chain/session.h"

#include <chrono>
#include <utility>

namespace strake {

void Session::provide(const std::string& port, Value value, const std::string& origin,
                      const std::string& digest) {
  values_[port] = {std::make_shared<Value>(std::move(value)), origin, digest};
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

const Report& Session::run(const Stage& stage, const std::string& last_use_of) {
  observer_->begin(stage.name);
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
  for (const std::string& warning : result.report.warnings()) {
    const std::string text = stage.name + ": warning: " + warning;
    if (warned_of_->insert(text).second) say(text);
  }
  if (result.output) provide(stage.output.name, std::move(*result.output), stage.output.name, "");
  StageRecord& record = record_of(stage);
  record = {provenance_of(stage), std::move(result.report)};
  note_inputs(stage, record.provenance);
  return record.report;
}

void Session::keep(const Stage& stage) {
  if (!keeper_) return;
  StageRecord& record = record_of(stage);
  note_inputs(stage, record.provenance);
  const auto entry = values_.find(stage.output.name);
  const Value* output = entry == values_.end() ? nullptr : entry->second.value.get();
  const std::string digest = keeper_({stage, record, output, get<TriMesh>("mesh"), seconds_});
  if (output != nullptr) entry->second.digest = digest;
}

}  // namespace strake
