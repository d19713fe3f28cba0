#include "strake/run/plan.h"

#include <fmt/format.h>
#include <fnmatch.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "common/artifact/digest.h"
#include "common/core/error.h"
#include "common/core/number_text.h"
#include "common/core/text.h"
#include "strake/run/rules.h"
#include "strake/run/run_paths.h"
#include "strake/run/stage_catalog.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestId = 200;  ///< a file name, with what comes before and after it
constexpr std::size_t kKeptDigits = 16;

Provenance provenance_with(const Step& step, const std::vector<Setting>& settings) {
  const Stage stage = make_stage(step.program);
  for (const Setting& setting : settings) {
    stage.option(setting.option).parse_into(setting.value);
  }
  return provenance_of(stage);
}

/// File name of a stage's artifact.
std::string artifact_name(const Stage& stage, const std::string& extension = "") {
  if (!extension.empty()) return stage.output.name + extension;
  const std::string& name = stage.output.kind == PortKind::report ? stage.name : stage.output.name;
  return name + output_extensions(stage.output.kind).front();
}

std::string filled_in(std::string text, const std::string& model, const std::string& variant) {
  const auto replace = [&](const std::string& mark, const std::string& value) {
    for (std::size_t at; (at = text.find(mark)) != std::string::npos;) {
      text.replace(at, mark.size(), value);
    }
  };
  replace("{model}", model);
  replace("{variant}", variant);
  return text;
}

/// Where a file is, or would be, without links on the way.
fs::path real_path(const fs::path& file) {
  std::error_code ignored;
  const fs::path real = fs::weakly_canonical(file, ignored);
  return real.empty() ? file : real;
}

/// \pre both are absolute and normal
bool is_below(const fs::path& path, const fs::path& folder) {
  return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first ==
         folder.end();
}

/// Faces of a model that the program makes itself: about what it is asked for.
double sample_faces(const Step& step) {
  const Provenance provenance = step_provenance(step);
  const auto faces = std::find_if(provenance.options.begin(), provenance.options.end(),
                                  [](const auto& option) { return option.name == "faces"; });
  return faces == provenance.options.end() ? 0 : parse_number(faces->value).value_or(0);
}

/// Vertices that the options of a step ask for, roughly; 0 where they do not say.
double wanted_vertices(const Step& step) {
  if (step.program == "sample") return 0;  // whose faces are those of the input
  constexpr std::array kCounts = {"vertices", "faces", "refine-vertices", "decimate-vertices"};
  double wanted = 0;
  for (const Provenance::OptionRecord& option : step_provenance(step).options) {
    if (option.value.empty()) continue;
    if (std::find(kCounts.begin(), kCounts.end(), option.name) != kCounts.end()) {
      wanted = parse_number(option.value).value_or(0);
    } else if (option.name == "tolerance" || option.name == "refine-tolerance") {
      const Length tolerance = Length::parse(option.value);
      if (tolerance.relative) wanted = vertices_within(tolerance.value);
    }
  }
  return wanted;
}

class Planner {
 public:
  Planner(const Description& description, const Selection& selection)
      : description_(description), selection_(selection) {
    plan_.store = description.store;
    sources_.emplace(real_path(description.file), "the pipeline file");
    for (const ModelEntry& model : description.models) {
      for (const auto& [name, file] : model.inputs) {
        sources_.emplace(real_path(file),
                         fmt::format("the '{}' of the model '{}'", name, model.name));
      }
      sources_.insert_or_assign(real_path(model.file), fmt::format("the model '{}'", model.name));
    }
  }

  Plan make() {
    check_targets();
    for (std::size_t m = 0; m < description_.models.size(); ++m) {
      const ModelEntry& model = description_.models[m];
      for (const Variant& variant : description_.variants) {
        const bool applies = std::find(model.variants.begin(), model.variants.end(),
                                       variant.name) != model.variants.end();
        if (!applies || !is_wanted(model.name, variant.name)) continue;
        if (model.missing.empty()) {
          add(m, variant);
        } else if (selection_.leave_out_missing) {
          plan_.left_out[model.name] = model.missing;
        } else {
          model.missing_place.fail(fmt::format("there is no file '{}'", model.missing.string()));
        }
      }
    }
    name_steps();
    return std::move(plan_);
  }

 private:
  [[nodiscard]] bool is_wanted(const std::string& model, const std::string& variant) const {
    const auto& targets = selection_.targets;
    return targets.empty() ||
           std::any_of(targets.begin(), targets.end(), [&](const std::string& target) {
             return target == model || target == model + "/" + variant;
           });
  }

  void check_targets() const {
    std::vector<std::string> known;
    for (const ModelEntry& model : description_.models) {
      known.push_back(model.name);
      for (const std::string& variant : model.variants) known.push_back(model.name + "/" + variant);
    }
    for (const std::string& target : selection_.targets) {
      if (std::find(known.begin(), known.end(), target) == known.end()) {
        throw UsageError(
            fmt::format("there is no target '{}'{}; targets are MODEL and "
                        "MODEL/VARIANT, see 'strake status'",
                        target, suggestion(target, known)));
      }
    }
  }

  /// The rules up to and including the last one of interest.
  [[nodiscard]] std::vector<const Rule*> wanted_rules() const {
    std::vector<const Rule*> rules;
    std::set<std::string> needed;
    for (auto rule = description_.rules.rbegin(); rule != description_.rules.rend(); ++rule) {
      const bool is_last = selection_.until && rule->name == *selection_.until;
      if (selection_.until && !is_last && needed.count(rule->output) == 0) continue;
      for (const auto& [port, artifact] : rule->inputs) needed.insert(artifact);
      rules.insert(rules.begin(), &*rule);
    }
    return rules;
  }

  /// Settings of a rule: each stronger one takes the place of those of the same option, and of
  /// those that it excludes.
  [[nodiscard]] static std::vector<Setting> settings_of(
      const std::string& rule, const std::vector<const std::vector<Setting>*>& weakest_first) {
    std::vector<Setting> all;
    for (const auto* source : weakest_first) {
      for (const Setting& setting : *source) {
        if (setting.rule != rule) continue;
        std::erase_if(all, [&](const Setting& weaker) {
          return weaker.option == setting.option || excludes(setting, weaker);
        });
        all.push_back(setting);
      }
    }
    return all;
  }

  void add(std::size_t model_index, const Variant& variant) {
    const fs::path folder = description_.file.parent_path();
    const ModelEntry& model = description_.models[model_index];
    std::map<std::string, StepInput> made;
    made[kModelArtifact] = {"", kNoStep, model.file};
    faces_ = 0;
    if (model.file.empty()) {
      static const std::vector<Rule> kSample = sample_rules();
      const std::size_t sample = step_for(model_index, kSample.front(), variant, made);
      faces_ = plan_.steps[sample].faces = sample_faces(plan_.steps[sample]);
      made[kModelArtifact].step = sample;
    } else {
      std::error_code ignored;
      const auto bytes = fs::file_size(model.file, ignored);
      faces_ = estimated_faces(ignored ? 0 : static_cast<std::int64_t>(bytes),
                               model.file.extension().string());
    }
    for (const auto& [name, file] : model.inputs) made[name] = {"", kNoStep, file};
    for (const Rule* rule : wanted_rules()) {
      const std::size_t step = step_for(model_index, *rule, variant, made);
      made[rule->output] = {"", step, {}};
      for (const Delivery& delivery : description_.deliveries) {
        if (delivery.artifact != rule->output) continue;
        const std::string name = filled_in(delivery.file, model.name, variant.name);
        deliver(step, without_dots(folder / name).string(), variant, delivery.place);
      }
    }
  }

  /// The step that makes this rule's artifact; a new one where no other variant has the same.
  std::size_t step_for(std::size_t model_index, const Rule& rule, const Variant& variant,
                       const std::map<std::string, StepInput>& made) {
    const ModelEntry& model = description_.models[model_index];
    const Stage stage = make_stage(rule.program);
    Step step;
    step.model = model.name;
    step.model_index = model_index;
    step.rule = rule.name;
    step.program = rule.program;
    std::vector<const std::vector<Setting>*> sources = {&description_.settings, &model.settings,
                                                        &variant.settings};
    step.usual_settings = settings_of(rule.name, sources);
    sources.push_back(&selection_.settings);
    step.settings = settings_of(rule.name, sources);
    step.file_name = artifact_name(stage);
    step.resources = rule.resources;
    step.faces = faces_;
    for (const Port& port : stage.inputs) {
      const auto source = rule.inputs.find(port.name);
      if (source == rule.inputs.end()) continue;
      const auto from = made.find(source->second);
      if (from == made.end()) continue;  // a file that this model does not have
      step.inputs.push_back(from->second);
      step.inputs.back().port = port.name;
    }
    step.vertices = wanted_vertices(step);
    for (const std::size_t need : needs_of(step)) {
      step.vertices = std::max(step.vertices, plan_.steps[need].vertices);
    }
    return share(std::move(step), variant, rule.parts);
  }

  /// An equal step there is already, or this one.
  std::size_t share(Step step, const Variant& variant, std::int64_t parts) {
    std::string identity = fmt::format("{}\n{}\n{}\n", step.model, step.rule, step.file_name);
    identity += step_provenance(step).to_json();
    for (const StepInput& input : step.inputs) {
      identity += fmt::format("\n{} {} {}", input.port, input.step, input.file.string());
    }
    const auto [known, is_new] = known_.emplace(identity, plan_.steps.size());
    if (is_new) {
      if (parts > 1) add_parts(step, parts);
      known->second = plan_.steps.size();
      plan_.steps.push_back(std::move(step));
    }
    std::vector<std::string>& variants = plan_.steps[known->second].variants;
    if (variants.empty() || variants.back() != variant.name) variants.push_back(variant.name);
    return known->second;
  }

  void add_parts(Step& whole, std::int64_t parts) {
    for (std::int64_t part = 1; part <= parts; ++part) {
      Step step = whole;
      step.program = whole.program + "-part";
      step.rule = fmt::format("{}-{}of{}", whole.rule, part, parts);
      step.settings.push_back({whole.rule, "parts", std::to_string(parts), {}});
      step.settings.push_back({whole.rule, "part", std::to_string(part), {}});
      step.file_name = artifact_name(make_stage(step.program));
      step.is_part = true;
      step.parts.clear();
      whole.parts.push_back(plan_.steps.size());
      plan_.steps.push_back(std::move(step));
    }
  }

  void deliver(std::size_t step, const std::string& file, const Variant& variant,
               const Place& place) {
    const std::string wanted = lower_case(fs::path(file).extension().string());
    if (wanted != fs::path(plan_.steps[step].file_name).extension()) {
      step = exported(step, wanted, variant);
    }
    const fs::path target = real_path(file);
    check_models_stay(file, place);
    if (const auto source = sources_.find(target); source != sources_.end()) {
      place.fail(fmt::format("'{}' is {}", file, source->second));
    }
    if (is_below(target, real_path(plan_.store))) {
      place.fail(
          fmt::format("'{}' lies in the store, whose files are strake's own; write it to "
                      "another folder",
                      file));
    }
    const auto [writer, is_new] = writers_.emplace(target, step);
    if (!is_new && writer->second != step) {
      place.fail(fmt::format("'{}' would be written twice, for '{}' too", file,
                             plan_.steps[writer->second].model));
    }
    std::vector<std::string>& files = plan_.steps[step].deliver_to;
    if (std::find(files.begin(), files.end(), file) == files.end()) files.push_back(file);
  }

  /// Refuses a file that would be a model of the next run.
  void check_models_stay(const std::string& file, const Place& place) const {
    for (const ModelPattern& pattern : description_.model_patterns) {
      if (::fnmatch(pattern.whole.c_str(), file.c_str(), FNM_PATHNAME | FNM_PERIOD) != 0) continue;
      place.fail(
          fmt::format("'{}' would be a model itself, as '{}' in 'models' matches it; write it to "
                      "another folder",
                      file, pattern.text));
    }
  }

  /// The step that turns a quads artifact into a mesh file of another format.
  std::size_t exported(std::size_t source, const std::string& extension, const Variant& variant) {
    const Stage stage = make_stage("export");
    Step step = plan_.steps[source];
    step.rule = "export" + extension;
    step.program = stage.name;
    step.variants.clear();
    step.settings.clear();
    step.usual_settings.clear();
    step.deliver_to.clear();
    step.parts.clear();
    step.inputs = {{stage.inputs.front().name, source, {}}};
    step.file_name = artifact_name(stage, extension);
    step.resources = default_resources(stage.name);
    return share(std::move(step), variant, 1);
  }

  void name_steps() {
    std::map<std::pair<std::string, std::string>, int> count;
    for (const Step& step : plan_.steps) ++count[{step.model, step.rule}];
    std::set<std::string> used;
    for (Step& step : plan_.steps) {
      step.id = step.model + "." + step.rule;
      step.title = step.model + " " + step.rule;
      if (count.at({step.model, step.rule}) > 1) {
        const std::string variant = step.variants.empty() ? "part" : step.variants.front();
        step.id += "." + variant;
        step.title += " (" + variant + ")";
      }
      if (step.id.size() > kLongestId) {
        step.id = step.id.substr(0, kLongestId - kKeptDigits) +
                  digest_text(step.id).substr(0, kKeptDigits);
      }
      for (int copy = 2; !used.insert(step.id).second; ++copy) {
        step.id += fmt::format(".{}", copy);
      }
    }
  }

  const Description& description_;
  const Selection& selection_;
  Plan plan_;
  std::map<std::string, std::size_t> known_;  ///< steps by what makes them equal
  std::map<fs::path, std::string> sources_;   ///< what a file of the user is, by its real path
  std::map<fs::path, std::size_t> writers_;   ///< steps by the real paths of what they give
  double faces_ = 0;                          ///< of the present model
};

}  // namespace

Plan make_plan(const Description& description, const Selection& selection) {
  return Planner(description, selection).make();
}

std::vector<Setting> idle_settings(const Plan& plan, const std::vector<Setting>& settings) {
  std::vector<Setting> idle;
  for (const Setting& setting : settings) {
    const auto is_of_it = [&](const Step& step) { return step.rule == setting.rule; };
    if (std::none_of(plan.steps.begin(), plan.steps.end(), is_of_it)) idle.push_back(setting);
  }
  return idle;
}

Provenance step_provenance(const Step& step) { return provenance_with(step, step.settings); }

Provenance usual_provenance(const Step& step) { return provenance_with(step, step.usual_settings); }

std::vector<std::size_t> needs_of(const Step& step) {
  std::set<std::size_t> needs(step.parts.begin(), step.parts.end());
  for (const StepInput& input : step.inputs) {
    if (input.step != kNoStep) needs.insert(input.step);
  }
  return {needs.begin(), needs.end()};
}

}  // namespace strake
