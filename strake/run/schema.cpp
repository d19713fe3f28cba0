#include "strake/run/schema.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <type_traits>
#include <variant>

#include "strake/run/stage_catalog.h"

namespace strake {
namespace {

using Json = nlohmann::ordered_json;

template <class T>
constexpr bool kIsOneOf(const Option::Target& target) {
  return std::holds_alternative<T*>(target) || std::holds_alternative<std::optional<T>*>(target);
}

Json number(const char* type, const Option& option) {
  Json json = {{"type", type}};
  if (std::isfinite(option.min)) json["minimum"] = option.min;
  if (std::isfinite(option.max)) json["maximum"] = option.max;
  return json;
}

/// What a single value of an option may be.
Json value_schema(const Option& option) {
  if (!option.choices.empty()) return {{"enum", option.choices}};
  if (std::holds_alternative<bool*>(option.target)) return {{"type", "boolean"}};
  if (kIsOneOf<std::int64_t>(option.target)) return number("integer", option);
  if (kIsOneOf<double>(option.target)) return number("number", option);
  if (takes_length(option)) {
    return {{"anyOf", {{{"type", "number"}}, {{"type", "string"}, {"pattern", "^[^%]+%?$"}}}}};
  }
  return {{"type", "string"}};
}

/// The options of a stage. \param lists  whether several values may be given
Json options_schema(const Stage& stage, bool lists) {
  Json properties = Json::object();
  for (const Option& option : stage.options) {
    Json value = value_schema(option);
    if (lists) value = {{"anyOf", {value, {{"type", "array"}, {"items", value}}}}};
    value["description"] = option.help;
    properties[option.name] = std::move(value);
  }
  return {{"type", {"object", "null"}},
          {"properties", std::move(properties)},
          {"additionalProperties", false}};
}

/// Options by stage; stages of other names than the programs' take any.
Json options_by_stage(bool lists) {
  Json properties = Json::object();
  for (const std::string& name : stage_names()) {
    properties[name] = options_schema(make_stage(name), lists);
  }
  return {{"type", {"object", "null"}},
          {"properties", std::move(properties)},
          {"additionalProperties", {{"type", {"object", "null"}}}}};
}

Json resources_schema() {
  // Text with a unit, or 0.
  const auto amount = [](const std::string& units) -> Json {
    return {{"type", {"string", "integer"}},
            {"pattern", "^[0-9.eE+-]+ *(" + units + ")$|^0$"},
            {"minimum", 0},
            {"maximum", 0}};
  };
  const Json bytes = amount("B|[kKMGT]B|[KMG]iB|[KMG]");
  const Json time = amount("us|ms|s|min|h|d");
  return {{"type", "object"},
          {"properties",
           {{"memory", bytes},
            {"memory-per-face", bytes},
            {"time", time},
            {"time-per-face", time},
            {"threads", {{"type", "integer"}, {"minimum", 0}}},
            {"parts", {{"type", "integer"}, {"minimum", 1}}}}},
          {"additionalProperties", false}};
}

Json stage_schema(const Json& options) {
  Json programs = Json::array();
  for (const std::string& name : stage_names()) {
    programs.push_back(name);
    programs.push_back("strake-" + name);
  }
  const Json text_or_null = {{"type", {"string", "null"}}};
  return {{"type", {"object", "null"}},
          {"properties",
           {{"program", {{"enum", programs}}},
            {"inputs", {{"type", "object"}, {"additionalProperties", text_or_null}}},
            {"output", {{"type", "string"}}},
            {"options", options},
            {"resources", resources_schema()}}},
          {"additionalProperties", false}};
}

Json stages_schema() {
  Json properties = Json::object();
  for (const std::string& name : stage_names()) {
    properties[name] = stage_schema(options_schema(make_stage(name), false));
  }
  return {{"type", "object"},
          {"description", "How each artifact is made, like rules of make."},
          {"properties", std::move(properties)},
          {"additionalProperties", stage_schema({{"type", {"object", "null"}}})}};
}

Json models_schema() {
  const Json file = {{"type", "string"}, {"description", "Mesh file: OBJ, PLY, OFF or STL."}};
  const Json names = {{"type", "array"}, {"items", {{"type", "string"}}}};
  const Json inputs = {
      {"type", "object"},
      {"description",
       "Files beside the mesh: guides, density, feature-edges, as stages take them."},
      {"additionalProperties", {{"type", "string"}}}};
  const Json model = {{"type", "object"},
                      {"properties",
                       {{"file", file},
                        {"sample", options_schema(make_stage("sample"), false)},
                        {"inputs", inputs},
                        {"options", options_by_stage(false)},
                        {"variants", names}}},
                      {"additionalProperties", false}};
  return {{"description", "Meshes to work on: a list of files and patterns, or entries by name."},
          {"anyOf",
           {{{"type", "array"}, {"items", file}},
            {{"type", "object"}, {"additionalProperties", {{"anyOf", {file, model}}}}}}}};
}

Json outputs_schema() {
  const Json file = {{"type", "string"}};
  return {{"type", {"object", "null"}},
          {"description", "Files to write, by artifact; {model} and {variant} are filled in."},
          {"additionalProperties", {{"anyOf", {file, {{"type", "array"}, {"items", file}}}}}}};
}

Json cluster_schema() {
  const Json option = {{"type", "string"}, {"pattern", "^-"}};
  const Json options = {
      {"type", "array"}, {"description", "For sbatch, e.g. --partition=long."}, {"items", option}};
  return {
      {"type", "object"}, {"properties", {{"options", options}}}, {"additionalProperties", false}};
}

}  // namespace

std::string pipeline_schema() {
  Json variants = {{"type", {"object", "null"}},
                   {"description", "Settings under a name; lists stand for one variant per value."},
                   {"additionalProperties", options_by_stage(true)}};
  const Json schema = {{"$schema", "http://json-schema.org/draft-07/schema#"},
                       {"title", "strake pipeline"},
                       {"type", "object"},
                       {"properties",
                        {{"version", {{"const", 1}}},
                         {"store", {{"type", "string"}}},
                         {"models", models_schema()},
                         {"stages", stages_schema()},
                         {"options", options_by_stage(false)},
                         {"variants", std::move(variants)},
                         {"outputs", outputs_schema()},
                         {"cluster", cluster_schema()}}},
                       {"required", {"version", "models"}},
                       {"additionalProperties", false}};
  return schema.dump(1) + "\n";
}

}  // namespace strake
