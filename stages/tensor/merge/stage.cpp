#include "stages/tensor/merge/stage.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "common/core/error.h"
#include "stages/tensor/stage.h"
#include "stages/tensor/tensor_part.h"

namespace strake {
namespace {

/// How the whole stage would have made what a part was made as.
Provenance whole_provenance(const Provenance& part) {
  Provenance whole = part;
  whole.stage = tensor_stage().name;
  std::erase_if(whole.options, [](const Provenance::OptionRecord& option) {
    return option.name == "parts" || option.name == "part";
  });
  return whole;
}

/// How the whole stage would have made what all the parts were made as.
/// \throw PreconditionError where they were made from different meshes or in different ways
Provenance common_provenance(const Inputs& inputs) {
  const std::vector<Input>& parts = inputs.all("parts");
  const Provenance whole = whole_provenance(parts.front().provenance.value());
  for (const Input& part : parts) {
    if (whole_provenance(part.provenance.value()) == whole) continue;
    throw PreconditionError("'" + part.origin +
                            "' was made with other options, by another version " +
                            "or from another file than '" + parts.front().origin +
                            "' (see strake info); make all parts the same way");
  }
  const Input& mesh = inputs.at("mesh");
  if (whole.inputs != std::vector<Provenance::InputRecord>{{"mesh", mesh.digest}}) {
    throw PreconditionError("the parts were not made from '" + mesh.origin +
                            "'; give the mesh they were made from, or make them again");
  }
  return whole;
}

}  // namespace

Stage tensor_merge_stage() {
  Stage stage;
  stage.name = "tensor-merge";
  stage.version = tensor_stage().version;
  stage.summary = "Puts the tensors of the parts of a mesh together.";
  stage.inputs = {{"mesh", PortKind::mesh, "mesh artifact"},
                  {.name = "parts",
                   .kind = PortKind::tensor_part,
                   .help = "artifacts of all parts of that mesh, in any order",
                   .many = true}};
  stage.output = {"tensor", PortKind::tensor, "tensor artifact to write, .hdf"};
  stage.run = [](const Inputs& inputs, Observer& /*observer*/) {
    const auto& mesh = inputs.get<TriMesh>("mesh");
    std::vector<const TensorPart*> parts;
    for (const Input& input : inputs.all("parts")) {
      parts.push_back(&std::get<TensorPart>(*input.value));
    }
    StageResult result;
    result.provenance = common_provenance(inputs);
    result.output = merge_tensor_parts(mesh.id, mesh.wedge_count(), parts);
    result.report.set("tensor.parts", parts.size());
    result.report.set("tensor.wedges", mesh.wedge_count());
    return result;
  };
  return stage;
}

}  // namespace strake
