#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/core/error.h"
#include "common/core/suggest.h"
#include "common/core/tolerance_error.h"
#include "python/cancellable.h"
#include "python/values.h"
#include "strake/chain/chain.h"
#include "strake/chain/remesh.h"

namespace strake::python {
namespace {

namespace py = pybind11;
using Settings = std::map<std::string, std::string>;

/// Sets options by their names. \throw UsageError where there is none of a name
void set(const OptionList& options, const Settings& settings) {
  std::vector<std::string> known;
  for (const Option& option : options) known.push_back(option.name);
  for (const auto& [name, text] : settings) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const std::string nearest = nearest_word(name, known);
      throw UsageError("there is no option '" + name + "'" +
                       (nearest.empty() ? "" : "; did you mean '" + nearest + "'?"));
    }
    options[static_cast<std::size_t>(found - known.begin())].parse_into(text);
  }
}

Stage make_stage(const std::string& name) {
  const Chain chain;
  for (const Stage* stage : chain.stages()) {
    if (stage->name == name) return *stage;
  }
  throw UsageError("there is no stage '" + name + "'");
}

/// What Python needs to describe options: name, unit, help and default of each.
std::vector<std::map<std::string, std::string>> describe(const OptionList& options) {
  std::vector<std::map<std::string, std::string>> all;
  for (const Option& option : options) {
    all.push_back({{"name", option.name},
                   {"unit", option.unit},
                   {"help", option.help},
                   {"default", option.value()}});
  }
  return all;
}

py::tuple run(const std::string& name, const std::map<std::string, Held>& given,
              const Settings& settings, std::int64_t threads, const py::object& progress) {
  const Stage stage = make_stage(name);
  set(stage.options, settings);
  for (const Port& port : stage.inputs) {
    if (!port.required || given.count(port.name) != 0) continue;
    throw UsageError("stage " + name + " needs its input '" + port.name + "'");
  }
  Inputs inputs;
  for (const auto& [port, held] : given) inputs.add(port, {held.value, port});
  StageResult result;
  run_cancellable(threads, progress, [&](StageObserver& observer) {
    observer.begin(stage.name);
    result = run_stage(stage, inputs, observer);
  });
  const py::object output = result.output ? hold(std::move(*result.output)) : py::none();
  return py::make_tuple(output, report_dict(result.report), result.report.warnings());
}

py::tuple remesh_polygons(const HeldAs<Polygons>& polygons,
                          const std::optional<HeldAs<EdgeList>>& edges,
                          const std::optional<HeldAs<GuideLines>>& guides,
                          const std::optional<HeldAs<DensityField>>& density,
                          const Settings& settings, bool measure, std::int64_t threads,
                          const py::object& progress) {
  RemeshOptions options;
  options.measure = measure;
  set(options.declare(), settings);
  RemeshInput input{polygons.get().mesh, edges ? edges->get() : EdgeList{},
                    guides ? guides->get() : GuideLines{},
                    density ? density->get().value : std::vector<double>{}};
  RemeshResult result;
  run_cancellable(threads, progress, [&](StageObserver& observer) {
    result = remesh(std::move(input), options, observer);
  });
  py::dict reports;
  for (const auto& [stage, report] : result.reports) reports[py::str(stage)] = report_dict(report);
  return py::make_tuple(hold(std::move(result.quads)), hold(std::move(result.mesh)),
                        hold(std::move(result.field)), reports, result.messages);
}

/// An exception per kind of error, all of them derived from `Error`.
void add_errors(py::module_& module) {
  const auto& base = py::register_exception<Error>(module, "Error", PyExc_RuntimeError);
  const auto both = [&](PyObject* builtin) {
    return py::make_tuple(base, py::reinterpret_borrow<py::object>(builtin));
  };
  py::register_exception<UsageError>(module, "UsageError", both(PyExc_ValueError));
  py::register_exception<InputError>(module, "InputError", both(PyExc_ValueError));
  py::register_exception<PreconditionError>(module, "PreconditionError", both(PyExc_ValueError));
  py::register_exception<AlgorithmError>(module, "AlgorithmError", base);
  py::register_exception<ToleranceError>(module, "ToleranceError", base);
}

}  // namespace
}  // namespace strake::python

PYBIND11_MODULE(_core, module) {
  using namespace strake::python;
  module.doc() = "The compiled part of the package strake.";
  add_errors(module);
  add_values(module);
  module.def("run", &run, py::arg("stage"), py::arg("inputs"), py::arg("options"),
             py::arg("threads"), py::arg("progress"));
  module.def("remesh", &remesh_polygons, py::arg("polygons"), py::arg("feature_edges"),
             py::arg("guides"), py::arg("density"), py::arg("options"), py::arg("measure"),
             py::arg("threads"), py::arg("progress"));
  module.def("stage_options",
             [](const std::string& stage) { return describe(make_stage(stage).options); });
  module.def("remesh_options", [] { return describe(strake::RemeshOptions().declare()); });
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&end_all));
  module.attr("__version__") = STRAKE_VERSION;
}
