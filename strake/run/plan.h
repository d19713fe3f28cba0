#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/artifact/provenance.h"
#include "strake/run/description.h"

namespace strake {

inline constexpr std::size_t kNoStep = static_cast<std::size_t>(-1);

/// Where a step takes an input from: what another step makes, or a file.
struct StepInput {
  std::string port;
  std::size_t step = kNoStep;
  std::filesystem::path file;  ///< where there is no step
};

/// One run of a stage's program on one model; shared by all variants that want the same.
struct Step {
  std::string id;     ///< unique in the plan, can be a file name: "rocker-arm.trace.seed-7"
  std::string title;  ///< for people: "rocker-arm trace (seed-7)"
  std::string model;
  std::size_t model_index = 0;
  std::string rule;
  std::string program;                  ///< stage whose result this is
  std::vector<std::string> variants;    ///< that need it
  std::vector<Setting> settings;        ///< in the order in which they apply
  std::vector<Setting> usual_settings;  ///< without those of the selection
  std::vector<StepInput> inputs;        ///< in the order of the stage's ports
  std::string file_name;                ///< of the artifact: "lines.hdf"
  std::vector<std::string> deliver_to;  ///< files to copy the artifact to, absolute
  Resources resources;
  double faces = 0;     ///< of the model, roughly
  double vertices = 0;  ///< of the result it works on, roughly; 0 before there is one
  /// Steps whose artifacts are parts of this one's: with them the program is "tensor-merge".
  std::vector<std::size_t> parts;
  bool is_part = false;  ///< of use only while the step it is a part of has to run
};

/// What there is to do, each step after those it needs.
struct Plan {
  std::filesystem::path store;
  std::vector<Step> steps;
  /// Models without steps, since a file of theirs is not there, and that file.
  std::map<std::string, std::filesystem::path> left_out;
};

/// What the user wants of a description.
struct Selection {
  std::vector<std::string> targets;  ///< "MODEL" or "MODEL/VARIANT"; empty: everything
  std::optional<std::string> until;  ///< last rule of interest
  std::vector<Setting> settings;     ///< that go before all others
  bool leave_out_missing = false;    ///< models that lack a file, instead of refusing them
};

/// Unfolds models, variants and rules. Reads no artifact.
/// \throw UsageError where a target or rule does not exist, or a file of a model that is wanted
Plan make_plan(const Description& description, const Selection& selection);

/// Those of the settings that no step of the plan has, as their stages come after the last one.
std::vector<Setting> idle_settings(const Plan& plan, const std::vector<Setting>& settings);

/// The stage and its options as the step wants them; inputs are to be filled in.
Provenance step_provenance(const Step& step);
/// The same without the settings of the selection.
Provenance usual_provenance(const Step& step);

/// The steps that a step waits for: makers of its inputs, and its parts.
std::vector<std::size_t> needs_of(const Step& step);

}  // namespace strake
