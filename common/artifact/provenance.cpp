#include "common/artifact/provenance.h"

#include <nlohmann/json.hpp>

#include "common/core/error.h"

namespace strake {

using Json = nlohmann::ordered_json;

std::string Provenance::to_json() const {
  Json json = {{"stage", stage},
               {"stage_version", stage_version},
               {"options", Json::object()},
               {"inputs", Json::object()}};
  for (const OptionRecord& option : options) {
    json["options"][option.name] = {{"value", option.value}, {"default", option.is_default}};
  }
  for (const InputRecord& input : inputs) json["inputs"][input.role] = input.digest;
  constexpr bool kAsciiOnly = true;
  return json.dump(-1, ' ', kAsciiOnly, Json::error_handler_t::replace);
}

Provenance Provenance::from_json(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    Provenance provenance;
    provenance.stage = json.at("stage").get<std::string>();
    provenance.stage_version = json.at("stage_version").get<int>();
    for (const auto& [name, record] : json.at("options").items()) {
      provenance.options.push_back(
          {name, record.at("value").get<std::string>(), record.at("default").get<bool>()});
    }
    for (const auto& [role, digest] : json.at("inputs").items()) {
      provenance.inputs.push_back({role, digest.get<std::string>()});
    }
    return provenance;
  } catch (const nlohmann::json::exception& error) {
    throw InputError(std::string("provenance cannot be read: ") + error.what());
  }
}

}  // namespace strake
