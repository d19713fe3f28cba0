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
  std::string help;        ///< a few words
  bool required = true;    ///< an input that is not required is given as --name
  bool many = false;       ///< takes one or more files; the last port that is required
  bool of_parent = false;  ///< belongs to what the mesh of the stage is a coarser one of
};

/// A value that goes into a stage, and what is known of it.
struct Input {
  std::shared_ptr<Value> value;               ///< never changed while others hold it
  std::string origin;                         ///< file or stage it comes from, for messages
  std::string digest = {};                    ///< content digest of the file, if there is one
  std::optional<Provenance> provenance = {};  ///< of an artifact
};

/// The values a stage runs on, by port.
class Inputs {
 public:
  /// Gives a port a value; a port that takes many gets one more.
  void add(const std::string& port, Input input) { values_[port].push_back(std::move(input)); }
  /// How many values the port has.
  [[nodiscard]] std::size_t count(const std::string& port) const {
    return has(port) ? all(port).size() : 0;
  }
  [[nodiscard]] bool has(const std::string& port) const { return values_.count(port) != 0; }
  /// Everything given to the port, in order. \pre has(port)
  [[nodiscard]] const std::vector<Input>& all(const std::string& port) const {
    return values_.at(port);
  }
  /// The first. \pre has(port)
  [[nodiscard]] const Input& at(const std::string& port) const { return all(port).front(); }
  template <class T>
  [[nodiscard]] const T& get(const std::string& port) const {
    return std::get<T>(*at(port).value);
  }
  /// The mesh that a value belongs to, by its id; nullptr where no port was given it.
  [[nodiscard]] const TriMesh* mesh_of(const Value& value) const;
  /// The first, for good: moved out where nobody else holds it, so that its memory can be used for
  /// other things, else copied.
  /// \pre has(port), and the port is not asked again
  template <class T>
  [[nodiscard]] T take(const std::string& port) {
    const std::shared_ptr<Value> value = std::move(values_.at(port).front().value);
    if (value.use_count() == 1) return std::get<T>(std::move(*value));
    return std::get<T>(*value);
  }
  /// nullptr where the port was not given, or something else.
  template <class T>
  [[nodiscard]] const T* find(const std::string& port) const {
    return has(port) ? std::get_if<T>(at(port).value.get()) : nullptr;
  }

 private:
  std::map<std::string, std::vector<Input>> values_;
};

struct StageResult {
  std::optional<Value> output;  ///< none where the report is the result
  Report report;
  /// How the output was made, where that is not by this stage: a merge of parts gives what another
  /// stage gives at once, and the file says so.
  std::optional<Provenance> provenance = {};
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
  std::vector<std::string> defaults;                   ///< of `options`, as text
  std::function<StageResult(Inputs&, Observer&)> run;  ///< may take its inputs

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
  stage.run = [options, run](Inputs& inputs, Observer& observer) {
    return run(inputs, *options, observer);
  };
  return stage;
}

/// Checks that the inputs belong together and lengths are in range for them, runs the stage, and
/// checks what its result promises.
/// \throw PreconditionError, UsageError, Error(internal) where the result is unsound, and what the
/// stage throws
StageResult run_stage(const Stage& stage, Inputs& inputs, Observer& observer);

/// The stage, its version and its resolved options; inputs are to be filled in by the caller.
Provenance provenance_of(const Stage& stage);

}  // namespace strake
