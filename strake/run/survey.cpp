#include "strake/run/survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "common/artifact/atomic_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

/// What differs between the way an artifact was made and the way it is wanted now.
std::vector<std::string> differences(const Provenance& before, const Provenance& now) {
  std::vector<std::string> all;
  if (before.stage_version != now.stage_version) {
    all.push_back(fmt::format("stage version {} -> {}", before.stage_version, now.stage_version));
  }
  for (const auto& option : now.options) {
    const auto old = std::find_if(before.options.begin(), before.options.end(),
                                  [&](const auto& other) { return other.name == option.name; });
    if (old == before.options.end()) {
      all.push_back("new option " + option.name);
    } else if (old->value != option.value) {
      const auto shown = [](const std::string& value) { return value.empty() ? "none" : value; };
      all.push_back(
          fmt::format("{} {} -> {}", option.name, shown(old->value), shown(option.value)));
    }
  }
  for (const auto& input : now.inputs) {
    const auto old = std::find_if(before.inputs.begin(), before.inputs.end(),
                                  [&](const auto& other) { return other.role == input.role; });
    if (old == before.inputs.end()) {
      all.push_back("new input " + input.role);
    } else if (old->digest != input.digest) {
      all.push_back("other content of its input '" + input.role + "'");
    }
  }
  for (const auto& input : before.inputs) {
    const bool is_left = std::any_of(now.inputs.begin(), now.inputs.end(),
                                     [&](const auto& other) { return other.role == input.role; });
    if (!is_left) all.push_back("without its input " + input.role);
  }
  return all;
}

class Surveyor {
 public:
  Surveyor(const Plan& plan, const Store& store, KnownDigests& digests,
           const std::set<std::string>& forced, Store::Check check)
      : plan_(plan), store_(store), digests_(digests), forced_(forced), check_(check) {}

  std::vector<StepState> survey() {
    states_.resize(plan_.steps.size());
    for (std::size_t s = 0; s < plan_.steps.size(); ++s) look_at(s);
    for (std::size_t s = 0; s < plan_.steps.size(); ++s) {
      if (states_[s].status != StepState::Status::stale) continue;
      for (const std::size_t part : plan_.steps[s].parts) {
        if (states_[s].forced) force_part(part);
        part_is_needed(part);
      }
    }
    return std::move(states_);
  }

 private:
  void look_at(std::size_t s) {
    const Step& step = plan_.steps[s];
    StepState& state = states_[s];
    state.forced = forced_.count(step.id) != 0;
    Provenance provenance = step_provenance(step);
    for (const StepInput& input : step.inputs) {
      if (input.step == kNoStep) {
        provenance.inputs.push_back({input.port, digests_.digest(input.file)});
      } else if (const auto& entry = states_[input.step].entry) {
        provenance.inputs.push_back({input.port, entry->content});
      } else {
        state.reason = "its input '" + input.port + "' has to be made first";
        return hide_part(s);
      }
    }
    state.key = key_of(provenance, fs::path(step.file_name).extension().string());
    const EntryName name = entry_name(step, state);
    std::string damage;
    state.entry = store_.find(name, check_, &damage);
    if (!damage.empty()) {
      state.damaged = true;
      state.reason = fmt::format("damaged: {} in {}", damage, store_.folder(name).string());
    } else if (!state.entry) {
      state.reason = reason_for(step, provenance);
    } else if (state.forced) {
      state.reason = "asked for with --force";
    } else {
      state.status = StepState::Status::cached;
      state.reason = "nothing it depends on has changed";
    }
    hide_part(s);
  }

  /// A part is not needed until the whole turns out to be.
  void hide_part(std::size_t s) {
    if (plan_.steps[s].is_part && states_[s].status == StepState::Status::stale) {
      states_[s].status = StepState::Status::unneeded;
    }
  }

  /// What makes a result again makes its parts again.
  void force_part(std::size_t part) {
    StepState& state = states_[part];
    state.forced = true;
    if (state.status == StepState::Status::cached) state.reason = "asked for with --force";
    state.status = StepState::Status::stale;
  }

  void part_is_needed(std::size_t part) {
    if (states_[part].status == StepState::Status::unneeded) {
      states_[part].status = StepState::Status::stale;
    }
  }

  /// Why there is no artifact of this key: what differs from the most similar one there is, of
  /// several from that of this variant.
  std::string reason_for(const Step& step, const Provenance& provenance) {
    const std::vector<Provenance::OptionRecord> usual = usual_provenance(step).options;
    std::vector<std::string> nearest;
    bool found = false;
    for (const Entry* entry : entries_of(step)) {
      const std::vector<std::string> all = differences(entry->provenance, provenance);
      if (all.empty()) continue;
      const bool is_own = entry->provenance.options == usual && all.size() == nearest.size();
      if (found && all.size() >= nearest.size() && !is_own) continue;
      nearest = all;
      found = true;
    }
    return found ? fmt::format("{}", fmt::join(nearest, ", ")) : "never made before";
  }

  std::vector<const Entry*> entries_of(const Step& step) {
    const auto [listing, is_new] = entries_.try_emplace(step.model);
    if (is_new) listing->second = store_.list(step.model);
    const std::string prefix = (fs::path(step.model) / (step.program + "-")).string();
    std::vector<const Entry*> found;
    for (const Store::Listed& listed : listing->second) {
      const bool is_same_stage = listed.folder.string().rfind(prefix, 0) == 0;
      if (is_same_stage && listed.entry && listed.entry->provenance.stage == step.program) {
        found.push_back(&*listed.entry);
      }
    }
    return found;
  }

  const Plan& plan_;
  const Store& store_;
  KnownDigests& digests_;
  const std::set<std::string>& forced_;
  Store::Check check_;
  std::vector<StepState> states_;
  std::map<std::string, std::vector<Store::Listed>> entries_;  ///< by model, once they are needed
};

}  // namespace

EntryName entry_name(const Step& step, const StepState& state) {
  return {step.model, step.program, *state.key};
}

std::vector<StepState> survey(const Plan& plan, const Store& store, KnownDigests& digests,
                              const std::set<std::string>& forced, Store::Check check) {
  return Surveyor(plan, store, digests, forced, check).survey();
}

std::vector<PendingDelivery> pending_deliveries(const Plan& plan,
                                                const std::vector<StepState>& states,
                                                KnownDigests& digests) {
  std::vector<PendingDelivery> pending;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (states[s].status != StepState::Status::cached) continue;
    for (const std::string& file : plan.steps[s].deliver_to) {
      if (digests.find(file) != states[s].entry->digest) pending.push_back({s, file});
    }
  }
  return pending;
}

std::vector<std::string> files_to_write(const Plan& plan, const std::vector<StepState>& states,
                                        KnownDigests& digests) {
  std::vector<std::string> files;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (states[s].status != StepState::Status::stale) continue;
    files.insert(files.end(), plan.steps[s].deliver_to.begin(), plan.steps[s].deliver_to.end());
  }
  for (const PendingDelivery& pending : pending_deliveries(plan, states, digests)) {
    files.push_back(pending.file);
  }
  return files;
}

std::string shown_path(const fs::path& file) {
  std::error_code ignored;
  const fs::path from_here = file.lexically_proximate(fs::current_path(ignored));
  const bool is_below = !from_here.empty() && *from_here.begin() != "..";
  return (is_below ? from_here : file).string();
}

void deliver(const fs::path& artifact, const fs::path& file) {
  std::error_code error;
  if (!fs::exists(artifact, error)) {
    throw InputError(
        fmt::format("'{}' has gone from the store before it was copied to '{}'; run again",
                    artifact.string(), file.string()));
  }
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  AtomicFile target(file);
  fs::copy_file(artifact, target.temporary(), fs::copy_options::overwrite_existing, error);
  if (error) {
    throw InputError(fmt::format("cannot copy '{}' to '{}': {}", artifact.string(), file.string(),
                                 error.message()));
  }
  target.commit();
}

}  // namespace strake
