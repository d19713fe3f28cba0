#include "common/stage/repro.h"

#include <fmt/format.h>

#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/stage/build_facts.h"

namespace strake {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void write_bundle(const Repro& repro, const std::string& message) {
  fs::create_directories(repro.folder);
  Json files = Json::array();
  for (const fs::path& input : repro.inputs) {
    const std::string name = fmt::format("{}-{}", files.size() + 1, input.filename().string());
    fs::copy_file(input, repro.folder / name, fs::copy_options::overwrite_existing);
    files.push_back(name);
  }
  const Json json = {{"message", message},
                     {"version", version_text(repro.program)},
                     {"files", files},
                     {"run", Json::parse(repro.provenance().to_json())}};
  constexpr bool kAsciiOnly = true;
  write_text(repro.folder / "repro.json",
             json.dump(2, ' ', kAsciiOnly, Json::error_handler_t::replace) + "\n");
}

/// Says what became of it; never throws, as an error is on its way.
void keep(const Repro& repro, const std::string& message) {
  if (repro.folder.empty()) return;
  std::string said;
  try {
    write_bundle(repro, message);
    said = fmt::format("{}: note: inputs, options and versions are in '{}'", repro.program,
                       repro.folder.string());
  } catch (const std::exception& error) {
    said = fmt::format("{}: warning: nothing was kept for repeating this: {}", repro.program,
                       error.what());
  }
  ConsoleObserver(Verbosity::normal, repro.format).say(said);
}

}  // namespace

void with_repro(const Repro& repro, const std::function<void()>& work) {
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const Error& error) {
    if (error.code() == ExitCode::internal || error.code() == ExitCode::algorithm_failed) {
      keep(repro, error.what());
    }
    throw;
  } catch (const std::exception& error) {
    keep(repro, error.what());
    throw;
  }
}

}  // namespace strake
