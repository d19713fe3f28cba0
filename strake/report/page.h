#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "strake/report/run_files.h"

namespace strake::report {

/// What is filled into the viewer's page.
struct PageData {
  std::string json;    ///< description of runs and blocks; safe inside a script element
  std::string blocks;  ///< all of them, packed
};

/// Turns runs into what the viewer shows. Runs on one mesh share its surface.
/// Deterministic for any thread count.
PageData describe_runs(const std::vector<RunFiles>& runs);

/// JSON text that cannot end the script element it is put into, whatever its strings hold.
std::string script_safe(std::string json);

/// Puts data into the viewer's page, in place of its two marks.
/// \throw PreconditionError where the page has not each mark once
std::string fill_page(std::string_view viewer, const PageData& data);

}  // namespace strake::report
