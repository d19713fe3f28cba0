#include "stages/sample/sample.h"

namespace strake {

OptionList SampleStageOptions::declare() {
  OptionList options = {{.name = "kind",
                         .target = &kind,
                         .unit = "",
                         .help = "Surface to make.",
                         .choices = sample_names()}};
  for (Option& option : sample.declare()) options.push_back(std::move(option));
  return options;
}

PolyMesh sample_surface(const SampleStageOptions& options) {
  return make_sample(sample_kind(options.kind), options.sample);
}

}  // namespace strake
