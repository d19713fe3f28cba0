#include "strake/run/stage_catalog.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "common/core/error.h"
#include "stages/coarsen/stage.h"
#include "stages/decimate/stage.h"
#include "stages/evaluate/stage.h"
#include "stages/export/stage.h"
#include "stages/fit/stage.h"
#include "stages/import/stage.h"
#include "stages/lift/stage.h"
#include "stages/mesh/stage.h"
#include "stages/prolong/stage.h"
#include "stages/refine/stage.h"
#include "stages/refine/uncross/stage.h"
#include "stages/refine/worst/stage.h"
#include "stages/sample/stage.h"
#include "stages/size/stage.h"
#include "stages/smooth/stage.h"
#include "stages/tensor/part/stage.h"
#include "stages/tensor/stage.h"
#include "stages/trace/stage.h"

namespace strake {
namespace {

using Maker = Stage (*)();

/// Not for rules: a rule of the stage tensor asks for its parts by `parts`.
constexpr const char* kTensorPart = "tensor-part";

const std::vector<std::pair<std::string, Maker>>& catalog() {
  static const std::vector<std::pair<std::string, Maker>> kCatalog = {
      {"sample", sample_stage},
      {"import", import_stage},
      {"tensor", tensor_stage},
      {"smooth", smooth_stage},
      {"coarsen", coarsen_stage},
      {"prolong", prolong_stage},
      {"trace", trace_stage},
      {"mesh", mesh_stage},
      {"lift", lift_stage},
      {"fit", fit_stage},
      {"refine", refine_stage},
      {"size", size_stage},
      {"decimate", decimate_stage},
      {"evaluate", evaluate_stage},
      {"export", export_stage},
      {"refine-uncross", refine_uncross_stage},
      {"refine-worst", refine_worst_stage},
  };
  return kCatalog;
}

}  // namespace

const std::vector<std::string>& stage_names() {
  static const std::vector<std::string> kNames = [] {
    std::vector<std::string> names;
    for (const auto& [name, maker] : catalog()) names.push_back(name);
    return names;
  }();
  return kNames;
}

Stage make_stage(const std::string& name) {
  if (name == kTensorPart) return tensor_part_stage();
  const auto found = std::find_if(catalog().begin(), catalog().end(),
                                  [&](const auto& entry) { return entry.first == name; });
  if (found == catalog().end()) {
    throw InputError("there is no stage '" + name + "': another version of strake knows it");
  }
  return found->second();
}

}  // namespace strake
