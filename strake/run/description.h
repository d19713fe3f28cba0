#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "strake/run/resources.h"
#include "strake/run/yaml_view.h"

/// What a pipeline file says, checked: docs/pipeline.md describes the file.
namespace strake {

/// The artifact name under which rules ask for the model itself.
inline constexpr const char* kModelArtifact = "model";

/// One option of one rule, as it was written; the value is known to be in range.
struct Setting {
  std::string rule;
  std::string option;
  std::string value;
  Place place;
  /// `Option::one_of`, where the value is not empty: others of the rule with the same exclude it.
  std::string one_of = {};
};

/// How one artifact of a model is made from others, like a rule of make.
struct Rule {
  std::string name;
  Place place;
  std::string program;                        ///< one of `stage_names`
  std::map<std::string, std::string> inputs;  ///< port of the program -> name of an artifact
  std::string output;                         ///< name of the artifact it makes
  Resources resources;
  std::int64_t parts = 1;  ///< processes that share the work, where the program can
};

struct ModelEntry {
  std::string name;
  Place place;
  std::filesystem::path file;         ///< absolute; empty: the program makes the model itself
  std::vector<Setting> settings;      ///< of the rule "sample" too, where there is no file
  std::vector<std::string> variants;  ///< names of those that apply
  /// A file that is not there, of those above and below, and the place that names it. To be told of
  /// where the model is wanted.
  std::filesystem::path missing = {};
  Place missing_place = {};
  /// Further files, absolute, by the name under which rules ask for them: guides, a density ...
  std::map<std::string, std::filesystem::path> inputs;
};

/// Settings under a name; several variants of a model share whatever they do not change.
struct Variant {
  std::string name;
  std::string entry;  ///< its key in the file, which may stand for several variants
  Place place;
  std::vector<Setting> settings;
};

/// A pattern that files of models match: "scans/*.ply".
struct ModelPattern {
  std::string text;   ///< as written
  std::string whole;  ///< absolute, marks of the folder's own name escaped
};

/// A file the user wants, for every model and variant.
struct Delivery {
  std::string artifact;
  std::string file;  ///< as written, with {model} and {variant} in it
  Place place;
};

struct Description {
  std::filesystem::path file;
  std::filesystem::path store;  ///< absolute
  std::vector<Rule> rules;      ///< each after those whose artifacts it needs
  std::vector<Setting> settings;
  std::vector<ModelEntry> models;
  std::vector<ModelPattern> model_patterns;
  std::vector<Variant> variants;  ///< at least one
  std::vector<Delivery> deliveries;
  std::vector<std::string> sbatch_options;  ///< for all jobs on a cluster
};

/// Reads and checks a pipeline file, before anything is run. Files of models may be missing.
/// \throw UsageError naming file, line and remedy; InputError where the file is missing
Description read_description(const std::filesystem::path& file);

/// A setting from the command line: "trace.seed=7".
/// \throw UsageError where there is no such rule or option, or the value is out of range
Setting parse_setting(const Description& description, const std::string& text);

}  // namespace strake
