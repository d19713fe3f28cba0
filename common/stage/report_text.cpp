#include "common/stage/report_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace strake {
namespace {

using Json = nlohmann::ordered_json;

/// The object that holds the last part of a dotted key, and that part.
std::pair<Json*, std::string> slot(Json& root, const std::string& key) {
  Json* object = &root;
  std::size_t begin = 0;
  for (std::size_t dot; (dot = key.find('.', begin)) != std::string::npos; begin = dot + 1) {
    Json& child = (*object)[key.substr(begin, dot - begin)];
    // A key that is both a value and a prefix of others keeps its value under "value".
    if (!child.is_object()) child = child.is_null() ? Json::object() : Json{{"value", child}};
    object = &child;
  }
  return {object, key.substr(begin)};
}

Json to_json(const Report& report) {
  Json root = Json::object();
  for (const auto& [key, value] : report.entries()) {
    const auto [object, name] = slot(root, key);
    std::visit([&, object = object, name = name](const auto& held) { (*object)[name] = held; },
               value);
  }
  return root;
}

Json to_json(const StageRecord& record) {
  Json json = Json::parse(record.provenance.to_json());
  json["result"] = to_json(record.report);
  json["warnings"] = record.report.warnings();
  return json;
}

std::string dump(const Json& json) {
  constexpr bool kAsciiOnly = true;
  return json.dump(2, ' ', kAsciiOnly, Json::error_handler_t::replace) + "\n";
}

}  // namespace

std::string record_json(const StageRecord& record) { return dump(to_json(record)); }

std::string records_json(const std::vector<StageRecord>& records) {
  Json json = Json::object();
  for (const StageRecord& record : records) json[record.provenance.stage] = to_json(record);
  return dump(json);
}

std::string times_json(const std::map<std::string, double>& seconds) {
  return dump({{"seconds", seconds}});
}

std::optional<std::map<std::string, double>> read_times(const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("seconds")) return std::nullopt;
  std::map<std::string, double> seconds;
  for (const auto& [stage, value] : json["seconds"].items()) {
    if (!value.is_number()) return std::nullopt;
    seconds[stage] = value;
  }
  return times_json(seconds) == text ? std::optional(seconds) : std::nullopt;
}

std::string value_text(const Report::Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{:.6g}", *number);
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "yes" : "no";
  return std::to_string(std::get<std::int64_t>(value));
}

std::string report_text(const Report& report) {
  std::size_t width = 0;
  for (const auto& [key, value] : report.entries()) width = std::max(width, key.size());
  std::string text;
  for (const auto& [key, value] : report.entries()) {
    text += fmt::format("{:{}}  {}\n", key + ":", width + 1, value_text(value));
  }
  return text;
}

}  // namespace strake
