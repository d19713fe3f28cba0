#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/artifact/store/store.h"
#include "strake/run/run_folder.h"

/// Has the steps of a run carried out by Slurm. Jobs are known by the run folder they work in,
/// never by remembered numbers: a controller may lose jobs and give their numbers to others.
namespace strake {

/// A task of this user that waits or runs.
struct QueuedTask {
  std::string job;  ///< number of the job or array
  bool waits = false;
  std::filesystem::path folder;  ///< that it works in
};

/// \throw InputError where Slurm is not installed or does not answer
std::vector<QueuedTask> slurm_queue();

/// Cancels tasks that wait for an earlier run of the same pipeline and store whose targets were all
/// asked for again. What runs is left alone: the new run waits for it, or finds its result.
/// \return number of tasks
std::size_t cancel_superseded(const std::vector<QueuedTask>& queue, const Store& store,
                              const RunSettings& settings);

/// Runs the submit script in the folder.
/// \return numbers of the jobs
/// \throw InputError with what sbatch said
std::vector<std::string> submit_to_slurm(const std::filesystem::path& scripts);

/// Waits until every step has ended or no task of the run is left, or until an interruption.
/// \param idle  called some times a second
void wait_for_slurm(const RunFolder& folder, const std::vector<StepOrder>& orders,
                    const std::function<void()>& idle);

}  // namespace strake
