#include "strake/run/target_results.h"

#include <algorithm>
#include <optional>

#include "common/artifact/store/store.h"
#include "common/core/error.h"
#include "strake/run/survey.h"

namespace strake {
namespace {

void add(const Step& step, const Entry& entry, TargetResults& results) {
  // Parts are of one stage with what they are parts of.
  const std::string stage =
      step.is_part ? step.program.substr(0, step.program.rfind('-')) : step.program;
  results.seconds[stage] += entry.seconds;
  if (!step.is_part) results.files.push_back(entry.file);
}

}  // namespace

std::vector<TargetResults> target_results(const Description& description,
                                          const Selection& selection) {
  const Plan plan = make_plan(description, selection);
  const Store store(plan.store);
  store.check_format();
  KnownDigests digests(store);
  const std::vector<StepState> states = survey(plan, store, digests, {}, Store::Check::stamp);
  std::vector<TargetResults> all;
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    const Step& step = plan.steps[s];
    const std::optional<Entry>& entry = states[s].entry;
    for (const std::string& variant : step.variants) {
      const std::string name = step.model + "/" + variant;
      if (!entry && states[s].status == StepState::Status::stale) {
        throw PreconditionError("target " + name + ": " + step.rule +
                                " is not in the store; make it with 'strake run'");
      }
      const auto known = std::find_if(all.begin(), all.end(),
                                      [&](const TargetResults& one) { return one.name == name; });
      TargetResults& results =
          known == all.end() ? all.emplace_back(TargetResults{name, {}, {}}) : *known;
      if (entry) add(step, *entry, results);
    }
  }
  return all;
}

}  // namespace strake
