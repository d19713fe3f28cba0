#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/stage/value.h"

namespace strake {

/// A place where a value goes into a stage or comes out.
struct Port {
  std::string name;
  PortKind kind = PortKind::report;
  std::string help;      ///< a few words
  bool required = true;  ///< an input that is not required is given as --name
};

/// The values a stage runs on, by port.
class Inputs {
 public:
  /// \param origin  file or stage the value comes from, for messages
  void set(const std::string& port, std::shared_ptr<const Value> value, std::string origin) {
    values_[port] = {std::move(value), std::move(origin)};
  }
  [[nodiscard]] bool has(const std::string& port) const { return values_.count(port) != 0; }
  [[nodiscard]] const Value& value(const std::string& port) const {
    return *values_.at(port).value;
  }
  [[nodiscard]] const std::string& origin(const std::string& port) const {
    return values_.at(port).origin;
  }
  template <class T>
  [[nodiscard]] const T& get(const std::string& port) const {
    return std::get<T>(value(port));
  }
  /// nullptr where the port was not given.
  template <class T>
  [[nodiscard]] const T* find(const std::string& port) const {
    return has(port) ? &get<T>(port) : nullptr;
  }

 private:
  struct Entry {
    std::shared_ptr<const Value> value;
    std::string origin;
  };
  std::map<std::string, Entry> values_;
};

struct StageResult {
  std::optional<Value> output;  ///< none where the report is the result
  Report report;
};

/// One step of the pipeline as data: what programs, the front end and engines need to know of it.
///
/// `options` points into state that `run` owns, so copies of a stage share their option values.
struct Stage {
  std::string name;     ///< "trace"; the program is strake-trace
  int version = 1;      ///< raised whenever the result changes for equal inputs and options
  std::string summary;  ///< one sentence
  std::vector<Port> inputs;
  Port output;
  OptionList options;
  std::vector<std::string> defaults;  ///< of `options`, as text
  std::function<StageResult(const Inputs&, Observer&)> run;

  /// The option of that name. \pre it exists
  [[nodiscard]] const Option& option(const std::string& option_name) const;
};

/// Completes a stage whose name, version, summary and ports are set.
/// \param run  called as run(inputs, options, observer), gives a StageResult
template <class Options, class Run>
Stage with_options(Stage stage, Run run) {
  auto options = std::make_shared<Options>();
  stage.options = options->declare();
  for (const Option& option : stage.options) stage.defaults.push_back(option.value());
  stage.run = [options, run](const Inputs& inputs, Observer& observer) {
    return run(inputs, *options, observer);
  };
  return stage;
}

/// Checks that the inputs belong together, then runs the stage.
/// \throw PreconditionError, and what the stage throws
StageResult run_stage(const Stage& stage, const Inputs& inputs, Observer& observer);

/// The stage, its version and its resolved options; inputs are to be filled in by the caller.
Provenance provenance_of(const Stage& stage);

}  // namespace strake
