#include "strake/run/description.h"

#include <fmt/format.h>
#include <glob.h>

#include <algorithm>
#include <optional>
#include <set>
#include <string_view>

#include "common/core/error.h"
#include "common/core/text.h"
#include "strake/run/rules.h"
#include "strake/run/run_paths.h"
#include "strake/run/slurm_options.h"
#include "strake/run/stage_catalog.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kTopKeys = {"version", "store",    "models",  "stages",
                                           "options", "variants", "outputs", "cluster"};
constexpr const char* kVersion = "1";

constexpr const char* kPatternMarks = "*?[";

/// Also false where the system cannot tell, as for names that are too long.
bool is_file(const fs::path& path) {
  std::error_code ignored;
  return fs::is_regular_file(path, ignored);
}

/// A pattern from the folder as an absolute one, in which marks in the folder's name are no marks.
std::string absolute_pattern(const fs::path& folder, const std::string& pattern) {
  std::string whole;
  if (fs::path(pattern).is_relative()) {
    for (const char c : folder.string() + "/") {
      if (c == '\\' || std::string_view(kPatternMarks).find(c) != std::string_view::npos) {
        whole += '\\';
      }
      whole += c;
    }
  }
  return whole + pattern;
}

/// Regular files that an absolute pattern matches, in alphabetical order.
std::vector<std::string> matching_files(const std::string& pattern) {
  glob_t matches = {};
  std::vector<std::string> files;
  if (::glob(pattern.c_str(), 0, nullptr, &matches) == 0) {
    for (std::size_t i = 0; i < matches.gl_pathc; ++i) {
      const fs::path file = without_dots(matches.gl_pathv[i]);
      if (is_file(file)) files.push_back(file.string());
    }
  }
  ::globfree(&matches);
  return files;
}

/// \param what  it is the path of: "a model"
void check_path(const fs::path& path, const char* what, const Place& place) {
  const std::string unfit = unfit_for_runs(path);
  if (unfit.empty()) return;
  place.fail(fmt::format("'{}': the path of {} cannot have {} in it; rename it",
                         on_one_line(path.string()), what, unfit));
}

/// The options of a stage. In the spelling of --set, "trace.seed: 7", they are refused with the one
/// that files have.
std::vector<YamlView::Entry> options_of(const YamlView::Entry& rule) {
  const std::size_t dot = rule.key.find('.');
  if (dot != std::string::npos && !rule.value.is_map()) {
    rule.place.fail(fmt::format(
        "'{}' is how --set names an option; here stages have theirs below: '{}: {{ {}: {} }}'",
        rule.key, rule.key.substr(0, dot), rule.key.substr(dot + 1),
        rule.value.is_scalar() ? rule.value.text("a value") : "VALUE"));
  }
  return rule.value.entries("options");
}

/// Reads one pipeline file; members are filled in the order in which they need each other.
class Reader {
 public:
  explicit Reader(const fs::path& file)
      : top_(YamlView::load(file).fields("a pipeline", kTopKeys)) {
    description_.file = without_dots(fs::absolute(file));
    folder_ = description_.file.parent_path();
    const std::string unfit = unfit_for_runs(folder_);
    if (unfit.empty()) return;
    throw UsageError(
        fmt::format("'{}': a pipeline cannot be run in a folder with {} in its path; rename it",
                    on_one_line(folder_.string()), unfit));
  }

  Description read() {
    if (!top_.count("version")) {
      start().fail(fmt::format("'version: {}' is missing at the top", kVersion));
    }
    const YamlView& version = top_.at("version");
    if (version.text("a version") != kVersion) {
      version.fail(fmt::format("version {} is not known; this program reads version {}",
                               version.text("a version"), kVersion));
    }
    read_store();
    description_.rules = top_.count("stages") ? read_rules(top_.at("stages"), description_.settings)
                                              : standard_rules(start());
    if (top_.count("options")) append_settings(top_.at("options"), description_.settings);
    read_variants();
    read_models();
    read_deliveries();
    read_cluster();
    return std::move(description_);
  }

 private:
  [[nodiscard]] Place start() const { return {description_.file, 1, 1}; }

  void read_store() {
    description_.store = folder_ / ".strake";
    if (!top_.count("store")) return;
    const YamlView& view = top_.at("store");
    description_.store = without_dots(folder_ / view.text("a folder") / "").parent_path();
    check_path(description_.store, "a store", view.place());
    if (description_.store != folder_) return;
    view.fail("the folder of the pipeline file cannot be the store; name one for results alone");
  }

  /// Settings nested by rule: "trace: {seed: 7}".
  void append_settings(const YamlView& view, std::vector<Setting>& settings) const {
    std::vector<Setting> own;
    for (const YamlView::Entry& rule : view.entries("options by stage")) {
      for (const YamlView::Entry& option : options_of(rule)) {
        own.push_back(checked_setting(
            description_.rules, {rule.key, option.key, option.value.text("a value"), option.place},
            rule.place));
      }
    }
    check_together(own);
    settings.insert(settings.end(), own.begin(), own.end());
  }

  /// The variants that one entry stands for: one per combination of its lists' values.
  void expand_variant(const YamlView::Entry& entry) {
    std::vector<Variant> expanded = {{entry.key, entry.key, entry.place, {}}};
    for (const YamlView::Entry& rule : entry.value.entries("options by stage")) {
      for (const YamlView::Entry& option : options_of(rule)) {
        const bool is_list = option.value.is_list();
        const std::vector<YamlView> values =
            is_list ? option.value.items("values") : std::vector<YamlView>{option.value};
        if (values.empty()) option.value.fail("a list of values makes variants; this one is empty");
        std::vector<Variant> combined;
        for (const Variant& variant : expanded) {
          for (const YamlView& value : values) {
            combined.push_back(variant);
            const std::string text = value.text("a value");
            if (is_list) combined.back().name += "-" + path_part(text);
            combined.back().settings.push_back(checked_setting(
                description_.rules, {rule.key, option.key, text, value.place()}, rule.place));
          }
        }
        expanded = std::move(combined);
      }
    }
    for (Variant& variant : expanded) {
      check_together(variant.settings);
      check_name(variant.name, variant.place);
      for (const Variant& other : description_.variants) {
        if (other.name == variant.name) {
          variant.place.fail(fmt::format("there are two variants '{}'", variant.name));
        }
      }
      description_.variants.push_back(std::move(variant));
    }
  }

  void read_variants() {
    if (top_.count("variants")) {
      for (const YamlView::Entry& entry : top_.at("variants").entries("variants by name")) {
        expand_variant(entry);
      }
    }
    if (description_.variants.empty())
      description_.variants.push_back({"default", "default", start(), {}});
  }

  void read_models() {
    if (!top_.count("models")) start().fail("'models' is missing: there is nothing to do");
    const YamlView& models = top_.at("models");
    if (models.is_list()) {
      for (const YamlView& item : models.items("models")) {
        add_files("", item.text("a mesh file or pattern"), item.place());
      }
    } else {
      for (const YamlView::Entry& entry : models.entries("models by name")) read_model(entry);
    }
    if (description_.models.empty()) models.fail("there is no model");
    check_side_inputs();
    check_sample_name();
  }

  void read_model(const YamlView::Entry& entry) {
    if (entry.value.is_scalar()) {
      add_files(entry.key, entry.value.text("a mesh file"), entry.value.place());
      return;
    }
    const auto fields =
        entry.value.fields("a model", {"file", "sample", "inputs", "options", "variants"});
    if (fields.count("file") == fields.count("sample")) {
      entry.place.fail("a model has either a 'file' or a 'sample'");
    }
    if (fields.count("file")) {
      add_files(entry.key, fields.at("file").text("a mesh file"), fields.at("file").place());
    } else {
      add_model(entry.key, entry.place, {});
      for (const auto& option : fields.at("sample").entries("options of a sample")) {
        description_.models.back().settings.push_back(checked_setting(
            sample_rules(), {"sample", option.key, option.value.text("a value"), option.place},
            option.place));
      }
    }
    ModelEntry& model = description_.models.back();
    if (fields.count("inputs")) read_inputs(fields.at("inputs"), model);
    if (fields.count("options")) append_settings(fields.at("options"), model.settings);
    if (fields.count("variants")) model.variants = variant_names(fields.at("variants"));
  }

  /// Files beside the mesh, under names that rules ask for.
  void read_inputs(const YamlView& view, ModelEntry& model) const {
    std::vector<std::string> names;
    for (const SideInput& input : side_inputs(description_.rules)) names.push_back(input.name);
    std::sort(names.begin(), names.end());
    names.erase(std::unique(names.begin(), names.end()), names.end());
    for (const auto& [name, value] : view.fields("inputs of a model", names)) {
      const fs::path file = without_dots(folder_ / value.text("a file"));
      check_path(file, "an input", value.place());
      if (!is_file(file)) note_missing(model, file, value.place());
      model.inputs[name] = file;
    }
  }

  /// Refuses a wire that was written out and that no model has a file for.
  void check_side_inputs() const {
    for (const SideInput& input : side_inputs(description_.rules)) {
      if (input.name == input.port) continue;  // as usual, for those models that have one
      const auto has = [&](const ModelEntry& model) { return model.inputs.count(input.name) != 0; };
      if (std::any_of(description_.models.begin(), description_.models.end(), has)) continue;
      input.rule->place.fail(fmt::format(
          "stage '{}' takes '{}' for its input '{}', but no stage makes it and no model has it "
          "among its 'inputs'",
          input.rule->name, input.name, input.port));
    }
  }

  /// What makes models goes by the name of its program, so that no stage can have it then.
  void check_sample_name() const {
    const auto is_made = [](const ModelEntry& model) { return model.file.empty(); };
    if (std::none_of(description_.models.begin(), description_.models.end(), is_made)) return;
    const std::string taken = sample_rules().front().name;
    for (const Rule& rule : description_.rules) {
      if (rule.name != taken) continue;
      rule.place.fail(
          fmt::format("'{0}' is what makes the models with 'sample:'; give this stage another name "
                      "and 'program: {1}'",
                      taken, rule.program));
    }
  }

  /// Names of variants; the name of an entry with lists stands for all it was expanded to.
  [[nodiscard]] std::vector<std::string> variant_names(const YamlView& view) const {
    std::vector<std::string> names;
    const std::vector<YamlView> items = view.items("names of variants");
    if (items.empty()) view.fail("there is no variant: a model without any gives nothing");
    for (const YamlView& item : items) {
      const std::string name = item.text("the name of a variant");
      const std::size_t before = names.size();
      std::vector<std::string> known;
      for (const Variant& variant : description_.variants) {
        known.push_back(variant.name);
        if (variant.name == name || variant.entry == name) names.push_back(variant.name);
      }
      if (names.size() == before) {
        item.fail(fmt::format("there is no variant '{}'{}", name, suggestion(name, known)));
      }
    }
    return names;
  }

  /// Adds the file, or each file that a pattern with * or ? matches, named by its stem.
  void add_files(const std::string& name, const std::string& text, const Place& place) {
    const fs::path file = without_dots(folder_ / text);
    const bool is_there = is_file(file);
    if (is_there || text.find_first_of(kPatternMarks) == std::string::npos) {
      const std::string own = name.empty() ? file.stem().string() : name;
      if (!is_there && name.empty() && !can_be_name(own)) {
        place.fail(fmt::format("there is no file '{}'", file.string()));
      }
      add_model(own, place, file);
      if (!is_there) note_missing(description_.models.back(), file, place);
      return;
    }
    const std::string pattern = absolute_pattern(folder_, text);
    const std::vector<std::string> paths = matching_files(pattern);
    if (paths.empty()) place.fail(fmt::format("no file matches '{}'", file.string()));
    if (!name.empty()) place.fail("patterns have no single name; list them under 'models: [...]'");
    for (const std::string& path : paths) add_model(fs::path(path).stem().string(), place, path);
    description_.model_patterns.push_back({text, fs::path(pattern).lexically_normal().string()});
  }

  static void note_missing(ModelEntry& model, const fs::path& file, const Place& place) {
    if (!model.missing.empty()) return;
    model.missing = file;
    model.missing_place = place;
  }

  void add_model(const std::string& name, const Place& place, const fs::path& file) {
    const std::string remedy = name != file.stem()
                                   ? ""
                                   : fmt::format("; name it yourself: 'models: {{ NAME: \"{}\" }}'",
                                                 file.lexically_proximate(folder_).string());
    check_name(name, place, remedy);
    check_path(file, "a model", place);
    for (const ModelEntry& other : description_.models) {
      if (other.name == name) place.fail(fmt::format("there are two models '{}'{}", name, remedy));
    }
    ModelEntry model;
    model.name = name;
    model.place = place;
    model.file = file;
    for (const Variant& variant : description_.variants) model.variants.push_back(variant.name);
    description_.models.push_back(std::move(model));
  }

  void read_deliveries() {
    if (!top_.count("outputs")) return;
    for (const YamlView::Entry& entry : top_.at("outputs").entries("files by artifact")) {
      const std::vector<YamlView> files =
          entry.value.is_list() ? entry.value.items("files") : std::vector<YamlView>{entry.value};
      for (const YamlView& file : files) {
        const std::string text = file.text("a file name");
        check_path(text, "an output", file.place());
        check_delivery(description_, entry, text, file.place());
        description_.deliveries.push_back({entry.key, text, file.place()});
      }
    }
  }

  void read_cluster() {
    if (!top_.count("cluster")) return;
    const auto fields = top_.at("cluster").fields("settings of a cluster", {"options"});
    if (!fields.count("options")) return;
    for (const YamlView& item : fields.at("options").items("options of sbatch")) {
      description_.sbatch_options.push_back(
          checked_sbatch_options(item.text("an option of sbatch"), item.place()));
    }
  }

  std::map<std::string, YamlView> top_;
  fs::path folder_;
  Description description_;
};

}  // namespace

Description read_description(const fs::path& file) { return Reader(file).read(); }

Setting parse_setting(const Description& description, const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::size_t dot = text.find('.');
  if (equals == std::string::npos || dot == std::string::npos || dot > equals) {
    throw UsageError("--set '" + text + "': write it as STAGE.OPTION=VALUE, e.g. trace.seed=7");
  }
  const Place place{"--set " + text};
  return checked_setting(
      description.rules,
      {text.substr(0, dot), text.substr(dot + 1, equals - dot - 1), text.substr(equals + 1), place},
      place);
}

}  // namespace strake
