#include "strake/run/rules.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>

#include "common/core/error.h"
#include "common/core/number_text.h"
#include "strake/run/stage_catalog.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

const std::vector<std::string> kRuleKeys = {"program", "inputs", "output", "options", "resources"};
const std::vector<std::string> kResourceKeys = {"memory",        "memory-per-face", "time",
                                                "time-per-face", "threads",         "parts"};
constexpr const char* kProgramPrefix = "strake-";
constexpr std::int64_t kMostParts = 4096;
constexpr std::size_t kLongestName = 100;

/// Stands for the result of all stages, until these are known; no name of an artifact.
constexpr const char* kResult = "<result>";

/// The artifact that a port takes unless the file says otherwise.
std::string usual_source(const std::string& port) {
  if (port == "input") return kModelArtifact;
  return port == "candidate" ? kResult : port;
}

Rule usual_rule(const std::string& name, const std::string& program, const Place& place) {
  const Stage stage = make_stage(program);
  Rule rule{name, place, program, {}, stage.output.name, default_resources(program), 1};
  for (const Port& port : stage.inputs) rule.inputs[port.name] = usual_source(port.name);
  return rule;
}

/// A part of a mesh is estimated by itself, and knows nothing of a coarser mesh.
void check_parts(const Rule& rule) {
  if (rule.parts == 1 || rule.inputs.count("coarse") == 0) return;
  rule.place.fail(
      fmt::format("stage '{}' cannot work in parts at the vertices of a coarser mesh; leave out "
                  "'parts', or write 'inputs: {{coarse: ~}}'",
                  rule.name));
}

const Rule* maker_of(const std::vector<Rule>& rules, const std::string& artifact) {
  const auto found = std::find_if(rules.begin(), rules.end(),
                                  [&](const Rule& rule) { return rule.output == artifact; });
  return found == rules.end() ? nullptr : &*found;
}

std::int64_t whole_number(const YamlView& view, std::int64_t least, std::int64_t most) {
  const std::string text = view.text("a number");
  const std::optional<std::int64_t> number = parse_whole_number(text);
  if (!number || *number < least || *number > most) {
    view.fail(fmt::format("'{}' must be a whole number from {} to {}", text, least, most));
  }
  return *number;
}

void read_resources(const YamlView& view, Rule& rule) {
  const auto fields = view.fields("resources", kResourceKeys);
  const auto amount = [&](const char* key, double& target, auto parse, const char* example) {
    const auto field = fields.find(key);
    if (field == fields.end()) return false;
    const std::string text = field->second.text("an amount");
    const std::optional<double> value = parse(text);
    if (!value) {
      field->second.fail(
          fmt::format("'{}' is none; write e.g. {}, a number and a unit", text, example));
    }
    target = *value;
    return true;
  };
  // Who gives an amount without the other part of the line means this amount.
  Resources& needs = rule.resources;
  if (amount("memory", needs.bytes, parse_bytes, "2GB")) {
    needs.bytes_per_face = needs.bytes_per_vertex = 0;
  }
  amount("memory-per-face", needs.bytes_per_face, parse_bytes, "300B");
  if (amount("time", needs.seconds, parse_seconds, "10min")) {
    needs.seconds_per_face = needs.seconds_per_vertex = 0;
  }
  amount("time-per-face", needs.seconds_per_face, parse_seconds, "20us");
  if (fields.count("threads")) needs.threads = whole_number(fields.at("threads"), 0, 4096);
  if (fields.count("parts")) {
    rule.parts = whole_number(fields.at("parts"), 1, kMostParts);
    if (rule.parts > 1 && rule.program != "tensor") {
      fields.at("parts").fail(
          fmt::format("the program '{}' cannot work in parts; 'tensor' can", rule.program));
    }
  }
}

/// The program of an entry, with or without "strake-".
std::string program_of(const YamlView::Entry& entry,
                       const std::map<std::string, YamlView>& fields) {
  const auto field = fields.find("program");
  std::string name = field == fields.end() ? entry.key : field->second.text("a program");
  if (name.rfind(kProgramPrefix, 0) == 0) name = name.substr(std::string(kProgramPrefix).size());
  const auto& known = stage_names();
  if (std::find(known.begin(), known.end(), name) == known.end()) {
    const Place place = field == fields.end() ? entry.place : field->second.place();
    place.fail(fmt::format("there is no stage program '{}'{}; known: {}{}", name,
                           suggestion(name, known), fmt::join(known, ", "),
                           field == fields.end() ? "; name one of them with 'program:'" : ""));
  }
  return name;
}

void read_inputs(const YamlView& view, Rule& rule) {
  std::vector<std::string> ports;
  for (const Port& port : make_stage(rule.program).inputs) ports.push_back(port.name);
  for (const auto& [port, artifact] : view.fields("inputs of the stage", ports)) {
    rule.inputs[port] = artifact.is_null() ? "" : artifact.text("the name of an artifact");
  }
}

Rule read_rule(const YamlView::Entry& entry, std::vector<Setting>& settings) {
  check_name(entry.key, entry.place);
  const auto fields = entry.value.fields("a stage", kRuleKeys);
  Rule rule = usual_rule(entry.key, program_of(entry, fields), entry.place);
  if (fields.count("inputs")) read_inputs(fields.at("inputs"), rule);
  if (fields.count("output")) {
    rule.output = fields.at("output").text("the name of the artifact");
    check_name(rule.output, fields.at("output").place());
  }
  if (fields.count("resources")) read_resources(fields.at("resources"), rule);
  if (fields.count("options")) {
    std::vector<Setting> own;
    for (const YamlView::Entry& option : fields.at("options").entries("options")) {
      own.push_back(checked_setting(
          {rule}, {rule.name, option.key, option.value.text("a value"), option.place},
          entry.place));
    }
    check_together(own);
    settings.insert(settings.end(), own.begin(), own.end());
  }
  return rule;
}

/// Whether what the maker gives may go into the port.
bool fits(PortKind given, PortKind wanted) {
  return given == wanted || (given == PortKind::quads && wanted == PortKind::polygons) ||
         (given == PortKind::polygons && wanted == PortKind::density);
}

/// Whether values of a kind are files of the user beside the mesh, which no stage makes.
bool is_side_file(PortKind kind) {
  return kind == PortKind::edge_list || kind == PortKind::density || kind == PortKind::guides;
}

/// Fills in the result: the faces of which no stage makes others.
void find_result(std::vector<Rule>& rules) {
  std::vector<std::string> results;
  for (const Rule& rule : rules) {
    if (make_stage(rule.program).output.kind == PortKind::quads) results.push_back(rule.output);
  }
  for (const Rule& rule : rules) {
    if (make_stage(rule.program).output.kind != PortKind::quads) continue;
    for (const auto& [port, source] : rule.inputs) std::erase(results, source);
  }
  for (Rule& rule : rules) {
    for (auto& [port, source] : rule.inputs) {
      if (source != kResult) continue;
      if (results.size() > 1) {
        rule.place.fail(
            fmt::format("stage '{}' may take any of {}; say which with 'inputs: {{{}: {}}}'",
                        rule.name, fmt::join(results, ", "), port, results.back()));
      }
      source = results.empty() ? port : results.front();
    }
  }
}

/// Checks that each input is made by some rule, of the right kind, or may be a file of a model;
/// drops ports left open.
void check_wires(std::vector<Rule>& rules) {
  find_result(rules);
  std::vector<std::string> artifacts = {kModelArtifact};
  for (const Rule& rule : rules) {
    if (std::find(artifacts.begin(), artifacts.end(), rule.output) != artifacts.end()) {
      rule.place.fail(fmt::format("two stages make '{}'; rename one with 'output:'", rule.output));
    }
    artifacts.push_back(rule.output);
  }
  for (Rule& rule : rules) {
    for (const Port& port : make_stage(rule.program).inputs) {
      const std::string source = rule.inputs.at(port.name);
      const Rule* maker = maker_of(rules, source);
      if (maker == nullptr && source != kModelArtifact) {
        const bool is_left_open = source.empty() || source == port.name;
        if (port.required || !(is_left_open || is_side_file(port.kind))) {
          rule.place.fail(
              fmt::format("stage '{}' needs '{}' for its input '{}', but no stage makes it{}",
                          rule.name, source, port.name, suggestion(source, artifacts)));
        }
        if (!is_side_file(port.kind) || source.empty()) rule.inputs.erase(port.name);
        continue;
      }
      const PortKind given =
          maker == nullptr ? PortKind::polygons : make_stage(maker->program).output.kind;
      if (!fits(given, port.kind)) {
        rule.place.fail(fmt::format("stage '{}': '{}' is of the wrong kind for its input '{}'",
                                    rule.name, source, port.name));
      }
    }
    check_parts(rule);
  }
}

/// Each rule after those it needs, otherwise in the order of the file.
std::vector<Rule> in_order(std::vector<Rule> rules) {
  std::vector<Rule> ordered;
  std::set<std::string> made;  // and what is there from the beginning
  for (const Rule& rule : rules) {
    for (const auto& [port, source] : rule.inputs) {
      if (maker_of(rules, source) == nullptr) made.insert(source);
    }
  }
  while (!rules.empty()) {
    const auto ready = std::find_if(rules.begin(), rules.end(), [&](const Rule& rule) {
      return std::all_of(rule.inputs.begin(), rule.inputs.end(),
                         [&](const auto& input) { return made.count(input.second) != 0; });
    });
    if (ready == rules.end()) {
      std::vector<std::string> names;
      for (const Rule& rule : rules) names.push_back(rule.name);
      rules.front().place.fail(
          fmt::format("the stages need each other in a cycle: {}", fmt::join(names, ", ")));
    }
    made.insert(ready->output);
    ordered.push_back(std::move(*ready));
    rules.erase(ready);
  }
  return ordered;
}

}  // namespace

std::vector<Rule> standard_rules(const Place& place) {
  std::vector<Rule> rules;
  // Without rounds of tracing, which a file must write out, and what needs a goal.
  const std::set<std::string> others = {"sample",       "export",  "coarsen", "prolong",
                                        "lift",         "size",    "refine",  "refine-uncross",
                                        "refine-worst", "decimate"};
  for (const std::string& name : stage_names()) {
    if (others.count(name) == 0) rules.push_back(usual_rule(name, name, place));
  }
  check_wires(rules);  // drops what is only there in rounds
  return rules;
}

std::vector<Rule> sample_rules() {
  Rule rule = usual_rule("sample", "sample", {});
  rule.output = kModelArtifact;
  return {rule};
}

std::vector<Rule> read_rules(const YamlView& view, std::vector<Setting>& settings) {
  std::vector<Rule> rules;
  for (const YamlView::Entry& entry : view.entries("stages by name")) {
    rules.push_back(read_rule(entry, settings));
  }
  if (rules.empty()) view.fail("there is no stage");
  check_wires(rules);
  return in_order(std::move(rules));
}

std::vector<SideInput> side_inputs(const std::vector<Rule>& rules) {
  std::vector<SideInput> all;
  for (const Rule& rule : rules) {
    for (const auto& [port, source] : rule.inputs) {
      if (source == kModelArtifact || maker_of(rules, source) != nullptr) continue;
      all.push_back({&rule, port, source});
    }
  }
  return all;
}

Setting checked_setting(const std::vector<Rule>& rules, Setting setting, const Place& rule_place) {
  std::vector<std::string> names;
  for (const Rule& rule : rules) names.push_back(rule.name);
  const auto rule = std::find(names.begin(), names.end(), setting.rule);
  if (rule == names.end()) {
    rule_place.fail(fmt::format("there is no stage '{}'{}; stages: {}", setting.rule,
                                suggestion(setting.rule, names), fmt::join(names, ", ")));
  }
  const Stage stage = make_stage(rules[static_cast<std::size_t>(rule - names.begin())].program);
  std::vector<std::string> known;
  for (const Option& option : stage.options) known.push_back(option.name);
  const auto option = std::find(known.begin(), known.end(), setting.option);
  if (option == known.end()) {
    setting.place.fail(fmt::format("stage '{}' has no option '{}'{}; known: {}", setting.rule,
                                   setting.option, suggestion(setting.option, known),
                                   fmt::join(known, ", ")));
  }
  try {
    stage.option(setting.option).parse_into(setting.value);
    setting.value = stage.option(setting.option).value();
    if (!setting.value.empty()) setting.one_of = stage.option(setting.option).one_of;
  } catch (const UsageError& error) {
    setting.place.fail(fmt::format("stage '{}': {}", setting.rule, error.what()));
  }
  return setting;
}

bool excludes(const Setting& one, const Setting& other) {
  return one.rule == other.rule && one.option != other.option && !one.one_of.empty() &&
         one.one_of == other.one_of;
}

void check_together(const std::vector<Setting>& settings) {
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!excludes(settings[i], settings[j])) continue;
      settings[i].place.fail(fmt::format("stage '{}': '{}' and '{}' exclude each other; give one",
                                         settings[i].rule, settings[j].option, settings[i].option));
    }
  }
}

bool can_be_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_' || c == '.' || c == '+';
  };
  return !name.empty() && name.size() <= kLongestName && name.front() != '.' &&
         name.front() != '-' && std::all_of(name.begin(), name.end(), is_allowed);
}

void check_name(std::string_view name, const Place& place, std::string_view remedy) {
  if (can_be_name(name)) return;
  place.fail(
      fmt::format("'{}' cannot be a name: letters, digits, '-', '_', '+' and '.' can, "
                  "at most {} of them, beginning with none of '.' and '-'{}",
                  name, kLongestName, remedy));
}

std::string path_part(std::string_view text) {
  std::string part;
  for (const char c : text) {
    if (c != '%' && c != ' ') part += c == '/' ? '_' : c;
  }
  return part;
}

void check_delivery(const Description& description, const YamlView::Entry& artifact,
                    const std::string& file, const Place& place) {
  std::vector<std::string> known;
  for (const Rule& rule : description.rules) known.push_back(rule.output);
  const Rule* maker = maker_of(description.rules, artifact.key);
  if (maker == nullptr) {
    artifact.place.fail(fmt::format("no stage makes '{}'{}; artifacts: {}", artifact.key,
                                    suggestion(artifact.key, known), fmt::join(known, ", ")));
  }
  const PortKind kind = make_stage(maker->program).output.kind;
  const std::string fault = check_extension(kind, file);
  if (!fault.empty()) place.fail(fault);
  for (std::size_t begin = file.find('{'); begin != std::string::npos;
       begin = file.find('{', begin + 1)) {
    if (file.compare(begin, 7, "{model}") != 0 && file.compare(begin, 9, "{variant}") != 0) {
      place.fail(fmt::format("'{}': only {{model}} and {{variant}} are filled in", file));
    }
  }
  const auto has = [&](const char* part) { return file.find(part) != std::string::npos; };
  if (description.models.size() > 1 && !has("{model}")) {
    place.fail(fmt::format("'{}': all models would write this file; put {{model}} in it", file));
  }
  if (description.variants.size() > 1 && !has("{variant}")) {
    place.fail(
        fmt::format("'{}': all variants would write this file; put {{variant}} in it", file));
  }
}

}  // namespace strake
