#include "strake/run/run_folder.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>

#include "common/artifact/text_file.h"
#include "common/core/error.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::array<const char*, 4> kOutcomeNames = {"ran", "found", "failed", "damaged"};

Json to_json(const EntryName& entry) {
  return {{"model", entry.model}, {"stage", entry.stage}, {"key", entry.key}};
}

EntryName entry_from(const Json& json) {
  return {json.at("model"), json.at("stage"), json.at("key")};
}

Json to_json(const std::vector<OrderedInput>& inputs) {
  Json list = Json::array();
  for (const OrderedInput& input : inputs) {
    Json json = {{"port", input.port}};
    if (input.from.empty()) {
      json["file"] = input.file.string();
      json["digest"] = input.digest;
      json["content"] = input.content;
      if (input.entry) json["entry"] = to_json(*input.entry);
    } else {
      json["from"] = input.from;
    }
    list.push_back(std::move(json));
  }
  return list;
}

std::vector<OrderedInput> inputs_from(const Json& list) {
  std::vector<OrderedInput> inputs;
  for (const Json& json : list) {
    OrderedInput input;
    input.port = json.at("port");
    input.from = json.value("from", "");
    input.file = json.value("file", "");
    input.digest = json.value("digest", "");
    input.content = json.value("content", "");
    if (json.contains("entry")) input.entry = entry_from(json.at("entry"));
    inputs.push_back(std::move(input));
  }
  return inputs;
}

/// Reads a file of the run folder. \throw InputError where it is missing or none of ours
template <class Use>
auto read_json(const fs::path& file, Use use) {
  std::ifstream stream(file);
  if (!stream) throw InputError(file.string() + ": cannot be read; run 'strake run' again");
  try {
    return use(Json::parse(stream));
  } catch (const nlohmann::json::exception& error) {
    throw InputError(file.string() + ": " + error.what() + "; run 'strake run' again");
  }
}

}  // namespace

RunFolder RunFolder::create(const Store& store, const RunSettings& settings) {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  const fs::path runs = store.side_folder("runs");
  const std::string name = fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(now), ::getpid());
  std::error_code error;
  fs::create_directories(runs, error);
  // Another round of this run in the same second, or another machine, may have that name.
  fs::path path = runs / name;
  for (int copy = 2; !error && !fs::create_directory(path, error) && !error; ++copy) {
    path = runs / fmt::format("{}-{}", name, copy);
  }
  for (const char* part : {"steps", "outcomes", "logs", "progress"}) {
    if (!error) fs::create_directory(path / part, error);
  }
  if (error) {
    throw InputError(
        fmt::format("store: cannot write '{}': {}; free space, check the rights, "
                    "or use another store",
                    path.string(), error.message()));
  }
  write_text(path / "run.json",
             Json{{"store", settings.store.string()},
                  {"memory", settings.memory},
                  {"keep_going", settings.keep_going},
                  {"pipeline", settings.pipeline.string()},
                  {"targets", settings.targets},
                  {"until", settings.until},
                  {"options", settings.options}}
                 .dump(1),
             Flush::no);
  return RunFolder(path);
}

RunSettings RunFolder::settings() const {
  return read_json(path_ / "run.json", [](const Json& json) {
    return RunSettings{json.at("store").get<std::string>(),
                       json.at("memory"),
                       json.at("keep_going"),
                       json.at("pipeline").get<std::string>(),
                       json.at("targets").get<std::vector<std::string>>(),
                       json.at("until"),
                       json.at("options").get<std::vector<std::string>>()};
  });
}

void RunFolder::write_order(const StepOrder& order) const {
  Json settings = Json::array();
  for (const Setting& setting : order.settings) {
    settings.push_back({setting.option, setting.value});
  }
  const Json json = {{"title", order.title},
                     {"model", order.model},
                     {"model_index", order.model_index},
                     {"rule", order.rule},
                     {"stage", order.stage},
                     {"program", order.program},
                     {"settings", settings},
                     {"inputs", to_json(order.inputs)},
                     {"parts", to_json(order.parts)},
                     {"file_name", order.file_name},
                     {"deliver_to", order.deliver_to},
                     {"memory", order.memory},
                     {"seconds", order.seconds},
                     {"threads", order.threads},
                     {"forced", order.forced}};
  write_text(path_ / "steps" / (order.id + ".json"), json.dump(1), Flush::no);
}

StepOrder RunFolder::order(const std::string& id) const {
  return read_json(path_ / "steps" / (id + ".json"), [&](const Json& json) {
    StepOrder order;
    order.id = id;
    order.title = json.at("title");
    order.model = json.at("model");
    order.model_index = json.at("model_index");
    order.rule = json.at("rule");
    order.stage = json.at("stage");
    order.program = json.at("program");
    for (const Json& setting : json.at("settings")) {
      order.settings.push_back({order.stage, setting.at(0), setting.at(1), {}});
    }
    order.inputs = inputs_from(json.at("inputs"));
    order.parts = inputs_from(json.at("parts"));
    order.file_name = json.at("file_name");
    order.deliver_to = json.at("deliver_to").get<std::vector<std::string>>();
    order.memory = json.at("memory");
    order.seconds = json.at("seconds");
    order.threads = json.at("threads");
    order.forced = json.at("forced");
    return order;
  });
}

void RunFolder::write_outcome(const std::string& id, const StepOutcome& outcome) const {
  const Json json = {{"outcome", kOutcomeNames[static_cast<std::size_t>(outcome.kind)]},
                     {"message", outcome.message},
                     {"warnings", outcome.warnings},
                     {"exit_code", outcome.exit_code},
                     {"entry", to_json(outcome.entry)},
                     {"file", outcome.file.string()},
                     {"digest", outcome.digest},
                     {"content", outcome.content},
                     {"seconds", outcome.seconds},
                     {"peak_bytes", outcome.peak_bytes}};
  constexpr bool kAsciiOnly = true;
  write_text(outcome_file(id), json.dump(1, ' ', kAsciiOnly, Json::error_handler_t::replace) + "\n",
             Flush::no);
}

std::optional<StepOutcome> RunFolder::outcome(const std::string& id) const {
  if (!fs::exists(outcome_file(id))) return std::nullopt;
  return read_json(outcome_file(id), [](const Json& json) {
    StepOutcome outcome;
    const std::string name = json.at("outcome");
    const auto* kind = std::find(kOutcomeNames.begin(), kOutcomeNames.end(), name);
    if (kind == kOutcomeNames.end()) throw InputError("there is no outcome '" + name + "'");
    outcome.kind = static_cast<StepOutcome::Kind>(kind - kOutcomeNames.begin());
    outcome.message = json.at("message");
    outcome.warnings = json.at("warnings").get<std::vector<std::string>>();
    outcome.exit_code = json.at("exit_code");
    outcome.entry = entry_from(json.at("entry"));
    outcome.file = json.at("file").get<std::string>();
    outcome.digest = json.at("digest");
    outcome.content = json.at("content");
    outcome.seconds = json.at("seconds");
    outcome.peak_bytes = json.at("peak_bytes");
    return outcome;
  });
}

bool RunFolder::is_local() const {
  std::error_code ignored;
  return fs::exists(ninja_file(), ignored);
}

bool RunFolder::has_ended() const {
  std::error_code ignored;
  const auto steps = fs::directory_iterator(path_ / "steps", ignored);
  return std::all_of(begin(steps), end(steps), [&](const fs::directory_entry& order) {
    return fs::exists(outcome_file(order.path().stem().string()), ignored);
  });
}

fs::path RunFolder::outcome_file(const std::string& id) const {
  return path_ / "outcomes" / (id + ".json");
}

fs::path RunFolder::log_file(const std::string& id) const { return path_ / "logs" / (id + ".txt"); }

fs::path RunFolder::progress_file(const std::string& id) const { return path_ / "progress" / id; }

std::vector<RunFolder::Running> RunFolder::running() const {
  std::vector<Running> all;
  std::error_code ignored;
  for (const auto& file : fs::directory_iterator(path_ / "progress", ignored)) {
    std::ifstream stream(file.path());
    Running running{file.path().filename().string(), ""};
    std::getline(stream, running.text);
    all.push_back(std::move(running));
  }
  std::sort(all.begin(), all.end(), [](const Running& a, const Running& b) { return a.id < b.id; });
  return all;
}

std::vector<StepOrder> stale_orders(const Plan& plan, const std::vector<StepState>& states,
                                    std::int64_t threads) {
  std::vector<StepOrder> orders;
  const auto input_of = [&](const std::string& port, std::size_t source) {
    OrderedInput input;
    input.port = port;
    const Step& maker = plan.steps[source];
    if (states[source].status == StepState::Status::stale) {
      input.from = maker.id;
    } else {
      input.file = states[source].entry->file;
      input.digest = states[source].entry->digest;
      input.content = states[source].entry->content;
      input.entry = entry_name(maker, states[source]);
    }
    return input;
  };
  for (std::size_t s = 0; s < plan.steps.size(); ++s) {
    if (states[s].status != StepState::Status::stale) continue;
    const Step& step = plan.steps[s];
    StepOrder order;
    order.id = step.id;
    order.title = step.title;
    order.model = step.model;
    order.model_index = step.model_index;
    order.rule = step.rule;
    order.stage = step.program;
    order.program = step.parts.empty() ? step.program : step.program + "-merge";
    order.settings = step.settings;
    for (const StepInput& input : step.inputs) {
      if (input.step != kNoStep) {
        order.inputs.push_back(input_of(input.port, input.step));
        continue;
      }
      OrderedInput file;
      file.port = input.port;
      file.file = input.file;
      order.inputs.push_back(std::move(file));
    }
    for (const std::size_t part : step.parts) order.parts.push_back(input_of("part", part));
    order.file_name = step.file_name;
    order.deliver_to = step.deliver_to;
    order.memory = step.resources.memory(step.faces, step.vertices);
    order.seconds = step.resources.time(step.faces, step.vertices);
    order.threads = step.resources.threads > 0 ? step.resources.threads : threads;
    order.forced = states[s].forced;
    orders.push_back(std::move(order));
  }
  return orders;
}

std::vector<std::string> ids_before(const StepOrder& order) {
  std::set<std::string> ids;
  for (const auto* inputs : {&order.inputs, &order.parts}) {
    for (const OrderedInput& input : *inputs) {
      if (!input.from.empty()) ids.insert(input.from);
    }
  }
  return {ids.begin(), ids.end()};
}

}  // namespace strake
