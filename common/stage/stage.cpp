#include "common/stage/stage.h"

#include "common/core/error.h"
#include "common/stage/invariants.h"

namespace strake {

namespace {

/// The diagonal of the mesh that the stage works on: of its mesh port where it has one.
double diagonal_of(const Stage& stage, const Inputs& inputs, const Port* mesh_port) {
  if (mesh_port != nullptr) return diagonal_of(*inputs.at(mesh_port->name).value);
  for (const Port& port : stage.inputs) {
    if (!inputs.has(port.name)) continue;
    if (const double diagonal = diagonal_of(*inputs.at(port.name).value); diagonal > 0) {
      return diagonal;
    }
  }
  return 0;
}

}  // namespace

const TriMesh* Inputs::mesh_of(const Value& value) const {
  const std::string id = mesh_id_of(value);
  for (const auto& [port, inputs] : values_) {
    for (const Input& input : inputs) {
      const auto* mesh = input.value ? std::get_if<TriMesh>(input.value.get()) : nullptr;
      if (mesh != nullptr && mesh->id == id) return mesh;
    }
  }
  return nullptr;
}

const Option& Stage::option(const std::string& option_name) const {
  for (const Option& option : options) {
    if (option.name == option_name) return option;
  }
  throw Error(ExitCode::internal, "stage " + name + " has no option " + option_name);
}

StageResult run_stage(const Stage& stage, Inputs& inputs, Observer& observer) {
  const Port* mesh_port = nullptr;
  for (const Port& port : stage.inputs) {
    if (port.kind == PortKind::mesh && !port.of_parent && inputs.has(port.name)) mesh_port = &port;
  }
  for (const Port& port : stage.inputs) {
    if (mesh_port == nullptr || &port == mesh_port || !inputs.has(port.name)) continue;
    const auto check = port.of_parent ? check_parent : check_belongs;
    for (const Input& input : inputs.all(port.name)) {
      check(inputs.get<TriMesh>(mesh_port->name), inputs.at(mesh_port->name).origin, *input.value,
            input.origin);
    }
  }
  check_lengths(stage.options, diagonal_of(stage, inputs, mesh_port));
  StageResult result = stage.run(inputs, observer);
  if (!result.output) return result;
  if (const std::string fault = broken_invariant(*result.output); !fault.empty()) {
    throw Error(ExitCode::internal, "internal error, please report it: the result of stage " +
                                        stage.name + " is unsound: " + fault);
  }
  return result;
}

Provenance provenance_of(const Stage& stage) {
  Provenance provenance;
  provenance.stage = stage.name;
  provenance.stage_version = stage.version;
  for (std::size_t i = 0; i < stage.options.size(); ++i) {
    const Option& option = stage.options[i];
    if (!option.affects_result) continue;
    const std::string value = option.value();
    provenance.options.push_back({option.name, value, value == stage.defaults[i]});
  }
  return provenance;
}

}  // namespace strake
