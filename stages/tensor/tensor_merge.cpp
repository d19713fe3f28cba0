#include <string>
#include <vector>

#include "common/core/error.h"
#include "stages/tensor/tensor_part.h"

/// The field of a mesh from those of its parts.
namespace strake {
namespace {

std::string name_of(Index part, Index parts) {
  return "part " + std::to_string(part) + " of " + std::to_string(parts);
}

/// Checks that each part of one division is there once.
void require_all(const std::vector<const TensorPart*>& given) {
  if (given.empty()) throw PreconditionError("there are no parts to merge");
  const Index parts = given.front()->parts;
  std::vector<Index> times(parts + 1, 0);
  for (const TensorPart* part : given) {
    if (part->parts != parts) {
      throw PreconditionError(name_of(given.front()->part, parts) + " and " +
                              name_of(part->part, part->parts) +
                              " do not belong together; give all parts of one division");
    }
    if (++times[part->part] > 1) {
      throw PreconditionError(name_of(part->part, parts) + " is given twice; leave one out");
    }
  }
  for (Index part = 1; part <= parts; ++part) {
    if (times[part] > 0) continue;
    throw PreconditionError(name_of(part, parts) +
                            " is missing; make it with strake-tensor-part --parts " +
                            std::to_string(parts) + " --part " + std::to_string(part));
  }
}

}  // namespace

TensorField merge_tensor_parts(const std::string& mesh_id, Index wedges,
                               const std::vector<const TensorPart*>& parts) {
  require_all(parts);
  TensorField field;
  field.mesh_id = mesh_id;
  field.tensor.resize(wedges);
  field.normal.resize(wedges);
  std::vector<std::uint8_t> is_set(wedges, 0);
  const auto refuse = [](Index wedge, const char* what) {
    throw PreconditionError("wedge " + std::to_string(wedge) + " of the mesh is in " + what +
                            "; make all parts again with one version of strake");
  };
  for (const TensorPart* part : parts) {
    for (std::size_t i = 0; i < part->wedge.size(); ++i) {
      const Index wedge = part->wedge[i];
      if (is_set[wedge] != 0) refuse(wedge, "two parts");
      is_set[wedge] = 1;
      field.tensor[wedge] = part->tensor[i];
      field.normal[wedge] = part->normal[i];
    }
  }
  for (Index wedge = 0; wedge < wedges; ++wedge) {
    if (is_set[wedge] == 0) refuse(wedge, "no part");
  }
  return field;
}

}  // namespace strake
