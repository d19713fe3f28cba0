#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "strake/run/description.h"
#include "strake/run/plan.h"

namespace strake {

/// What the store holds of one model in one variant.
struct TargetResults {
  std::string name;                          ///< "MODEL/VARIANT"
  std::vector<std::filesystem::path> files;  ///< artifacts of all stages
  std::map<std::string, double> seconds;     ///< that making them took, by stage; parts together
};

/// \return one for each model and variant that is selected, in the order of the file
/// \throw PreconditionError naming target and stage where something is stale
std::vector<TargetResults> target_results(const Description& description,
                                          const Selection& selection);

}  // namespace strake
