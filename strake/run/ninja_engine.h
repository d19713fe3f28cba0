#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "strake/run/run_folder.h"

namespace strake {

/// Has the ordered steps carried out on this machine by Ninja, and waits for them.
/// \param jobs  steps at once
/// \param idle  called some times a second
/// \return what Ninja said last where it did not end well; "" otherwise
/// \throw InputError where Ninja is not installed
std::string run_with_ninja(const RunFolder& folder, const std::vector<StepOrder>& orders,
                           std::int64_t jobs, const std::function<void()>& idle);

}  // namespace strake
