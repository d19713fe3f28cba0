#include "strake/run/slurm_scripts.h"

#include <fmt/format.h>

#include <map>

#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/core/text.h"
#include "strake/run/stage_command.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSubmitFunction = R"--(#
# 'submit SCRIPT EARLIER...' submits SCRIPT.sh. Each of its tasks starts once the tasks of the same
# index of the arrays EARLIER have succeeded, and is cancelled where one of them has failed.
set -eo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

# Variables SBATCH_* would override what the scripts say.
unset "${!SBATCH_@}"

declare -A job
# Where a submission fails, those before it are taken back.
trap 'if [ $? -ne 0 ] && [ ${#job[@]} -gt 0 ]; then scancel "${job[@]}"; fi' EXIT

submit() {
  local script=$1 options=() ids="" earlier id
  shift
  for earlier in "$@"; do ids+=":${job[$earlier]}"; done
  if [ -n "$ids" ]; then options=(--dependency="aftercorr$ids"); fi
  id=$(sbatch --parsable "${options[@]}" "$script.sh")
  job[$script]=${id%%;*}
  echo "${job[$script]} $script"
}

)--";

/// A word for the shell.
std::string shell_word(const std::string& text) {
  std::string word = "'";
  for (const char c : text) word += c == '\'' ? "'\\''" : std::string(1, c);
  return word + "'";
}

/// A value in an #SBATCH line.
std::string directive_value(const std::string& text) {
  std::string value = "\"";
  for (const char c : text)
    value += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return value + "\"";
}

/// Where Slurm writes what a task says. It fills in what follows '%' in the folder, too, also where
/// the name is relative and it puts the folder before it.
std::string log_pattern(const fs::path& run) {
  std::string pattern;
  for (const char c : (run / "logs").string()) pattern += c == '%' ? "%%" : std::string(1, c);
  return pattern + "/slurm-%A_%a.txt";
}

/// Task indices as sbatch takes them: "0-3,5".
std::string index_ranges(const SlurmArray& array) {
  std::string text;
  for (auto task = array.tasks.begin(); task != array.tasks.end();) {
    const std::size_t first = task->first;
    std::size_t last = first;
    while (++task != array.tasks.end() && task->first == last + 1) ++last;
    text += (text.empty() ? "" : ",") + std::to_string(first);
    if (last > first) text += "-" + std::to_string(last);
  }
  return text;
}

/// The pipeline's file, short, for names of jobs: "parts/pipeline".
std::string pipeline_name(const RunFolder& folder) {
  const fs::path file = folder.settings().pipeline;
  return (file.parent_path().filename() / file.stem()).string();
}

class ScriptWriter {
 public:
  ScriptWriter(const RunFolder& folder, const std::vector<StepOrder>& orders,
               const std::vector<SlurmArray>& arrays, const std::vector<std::string>& options)
      : folder_(folder), orders_(orders), arrays_(arrays), options_(options) {
    for (const StepOrder& order : orders) file_names_[order.id] = order.file_name;
  }

  [[nodiscard]] std::string job_script(const SlurmArray& array) const {
    const std::string run = folder_.path().filename().string();
    std::string text = fmt::format(
        "#!/bin/bash\n"
        "# {}: {} of {} models. A task is one step; its index is the place of its model in\n"
        "# {}\n",
        array.name, array.rule, array.tasks.size(),
        on_one_line(folder_.settings().pipeline.string()));
    text += fmt::format(
        "#SBATCH --job-name={}\n"
        "#SBATCH --array={}\n"
        "#SBATCH --ntasks=1 --cpus-per-task={} --mem={}M --time={}\n",
        directive_value(array.rule + ":" + pipeline_name(folder_) + ":" + run), index_ranges(array),
        array.threads, array.memory_mib, array.minutes);
    text += fmt::format(
        "#SBATCH --chdir={}\n"
        "#SBATCH --output={} --open-mode=append\n"
        "#SBATCH --requeue --kill-on-invalid-dep=yes\n"
        "# Environment and limits of the shell that submits do not matter.\n"
        "#SBATCH --export=NIL --propagate=NONE\n",
        directive_value(folder_.path().string()), directive_value(log_pattern(folder_.path())));
    for (const std::string& option : options_) text += "#SBATCH " + option + "\n";
    text += "\ncase $SLURM_ARRAY_TASK_ID in\n";
    for (const auto& [index, position] : array.tasks) {
      const StepOrder& order = orders_[position];
      text += fmt::format("  # {}\n  #   {}\n  {}) step={} ;;\n", order.title,
                          on_one_line(command(order)), index, order.id);
    }
    text += fmt::format("esac\nexec {} step {} \"$step\"\n",
                        shell_word((program_folder() / "strake").string()),
                        shell_word(folder_.path().string()));
    return text;
  }

  [[nodiscard]] std::string submit_script() const {
    std::string text = fmt::format(
        "#!/bin/bash\n"
        "# Submits {} steps as {} job arrays:\n"
        "# {}\n",
        orders_.size(), arrays_.size(), on_one_line(folder_.settings().pipeline.string()));
    text += kSubmitFunction;
    for (const SlurmArray& array : arrays_) {
      text += "submit " + array.name;
      for (const std::size_t earlier : array.after) text += " " + arrays_[earlier].name;
      text += "\n";
    }
    return text;
  }

 private:
  /// What the step comes to, for people: results of other steps are named by their ids.
  [[nodiscard]] std::string command(StepOrder order) const {
    for (auto* inputs : {&order.inputs, &order.parts}) {
      for (OrderedInput& input : *inputs) {
        if (!input.from.empty()) input.file = fs::path(input.from) / file_names_.at(input.from);
      }
    }
    std::vector<std::string> words = stage_command(order, order.file_name);
    words.front() = fs::path(words.front()).filename().string();
    return fmt::format("{}", fmt::join(words, " "));
  }

  const RunFolder& folder_;
  const std::vector<StepOrder>& orders_;
  const std::vector<SlurmArray>& arrays_;
  const std::vector<std::string>& options_;
  std::map<std::string, std::string> file_names_;  ///< of artifacts, by id of the step
};

void write_program(const fs::path& file, const std::string& text) {
  write_text(file, text);
  fs::permissions(file, fs::perms::owner_exec | fs::perms::group_exec, fs::perm_options::add);
}

}  // namespace

void check_slurm_takes(const fs::path& store) {
  if (store.string().find('\\') == std::string::npos) return;
  throw UsageError(
      fmt::format("the store '{}' has a backslash in its path, below which Slurm cannot write; "
                  "rename that folder, or name another one with 'store:' in the pipeline file",
                  store.string()));
}

void write_slurm_scripts(const fs::path& target, const RunFolder& folder,
                         const std::vector<StepOrder>& orders,
                         const std::vector<SlurmArray>& arrays,
                         const std::vector<std::string>& options) {
  std::error_code error;
  fs::create_directories(target, error);
  if (error) {
    throw InputError(fmt::format("cannot write '{}': {}", target.string(), error.message()));
  }
  const ScriptWriter writer(folder, orders, arrays, options);
  for (const SlurmArray& array : arrays) {
    write_program(target / (array.name + ".sh"), writer.job_script(array));
  }
  write_program(target / kSubmitScript, writer.submit_script());
}

}  // namespace strake
