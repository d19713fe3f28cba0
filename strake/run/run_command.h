#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "strake/run/pipeline_options.h"
#include "strake/run/run_folder.h"
#include "strake/run/survey.h"

namespace strake {

/// Names of the engines that carry out steps.
inline constexpr const char* kLocal = "local";
inline constexpr const char* kSlurm = "slurm";

/// Building what a pipeline describes: `strake run`, and `strake submit` as a way to call it.
struct RunCommand {
  PipelineOptions pipeline;
  std::string engine = kLocal;
  bool dry_run = false;
  bool explain = false;
  bool verify = false;
  bool quiet = false;
  std::string from;
  std::vector<std::string> forced;
  // Of the local engine.
  std::int64_t jobs = 0;
  std::string memory;
  bool keep_going = false;
  // Of Slurm.
  bool wait = false;
  std::vector<std::string> sbatch;
  bool script_only = false;
  std::string script_folder;

  void add_common_options(CLI::App& app);
  void add_local_options(CLI::App& app);
  void add_slurm_options(CLI::App& app);
  int run();

 private:
  void check_engine_options() const;
  /// Memory for all steps together, in bytes. \throw UsageError where --memory is none
  [[nodiscard]] std::int64_t wanted_memory() const;
  /// \throw UsageError where --until comes before --from
  void refuse_empty_range(const Plan& plan) const;
  void refuse_what_lies_before(const Plan& plan, const std::vector<StepState>& states) const;
  /// Ids of the steps that --force names.
  [[nodiscard]] std::set<std::string> forced_steps(const Plan& plan) const;
  void print_plan(const Plan& plan, const std::vector<StepState>& states) const;
  void write_outputs(const Plan& plan, const std::vector<StepState>& states,
                     KnownDigests& digests) const;
  [[nodiscard]] std::int64_t threads_for(const std::vector<StepOrder>& orders) const;
  [[nodiscard]] RunSettings settings(const Description& description) const;
  /// What became of the steps that were stale.
  struct Round {
    int exit_code = 0;  ///< of the first step that failed
    bool damaged =
        false;  ///< an input was damaged or went away: what is stale now has to be found out
    std::set<std::string> made;  ///< ids of steps whose results are there, or were
  };
  Round run_locally(const Description& description, const Plan& plan,
                    const std::vector<StepState>& states) const;
  Round run_on_cluster(const Description& description, const Plan& plan,
                       const std::vector<StepState>& states) const;
  Round conclude(const RunFolder& folder, const std::vector<StepOrder>& orders,
                 const std::string& complaint) const;
  [[nodiscard]] const char* done_to_steps() const;
};

}  // namespace strake
