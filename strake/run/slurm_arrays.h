#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "strake/run/run_folder.h"

/// How the steps of a run become job arrays of Slurm: docs/cluster.md says it with an example.
namespace strake {

/// Steps that are submitted together: the same rule for several models. A task's index is the place
/// of its model in the pipeline file, so with `aftercorr` a task waits for its own model only.
struct SlurmArray {
  std::string name;  ///< unique in the run, can be a file name: "04-trace"
  std::string rule;
  std::map<std::size_t, std::size_t> tasks;  ///< index of the task -> position in the orders
  std::vector<std::size_t> after;            ///< positions of arrays, all before this one
  std::int64_t threads = 1;
  std::int64_t memory_mib = 0;
  std::int64_t minutes = 0;
};

/// Array indices stay below this; further models go to further arrays. Slurm's default limit
/// (MaxArraySize) is 1001.
inline constexpr std::size_t kMostTasks = 1000;

/// Groups steps into arrays such that all tasks of an array need the same resources and depend on
/// the same arrays, each of which has a task of the same index for it.
/// \param orders  each after those it needs
/// \return        each array after those it depends on; every order is a task of one of them
std::vector<SlurmArray> slurm_arrays(const std::vector<StepOrder>& orders);

}  // namespace strake
