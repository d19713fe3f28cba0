#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "strake/run/run_folder.h"
#include "strake/run/slurm_arrays.h"

namespace strake {

inline constexpr const char* kSubmitScript = "submit.sh";

/// \throw UsageError where jobs could not write their logs into this store, for what its path holds
void check_slurm_takes(const std::filesystem::path& store);

/// Writes a job script per array, and `submit.sh`, which submits them in order and prints a line
/// "JOB NAME" for each. They can be read, changed and run by hand.
/// \param target   folder to write to; is made where it is missing
/// \param folder   the run; holds the orders
/// \param options  for sbatch; each becomes an #SBATCH line behind strake's own, so it overrides
/// \throw InputError where they cannot be written
void write_slurm_scripts(const std::filesystem::path& target, const RunFolder& folder,
                         const std::vector<StepOrder>& orders,
                         const std::vector<SlurmArray>& arrays,
                         const std::vector<std::string>& options);

}  // namespace strake
