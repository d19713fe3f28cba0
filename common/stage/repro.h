#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/artifact/provenance.h"
#include "common/stage/console.h"

namespace strake {

/// Where what a run was made of is kept if it fails by a fault of the program.
struct Repro {
  std::filesystem::path folder;               ///< "": nowhere
  std::string program;                        ///< "strake-trace"
  std::vector<std::filesystem::path> inputs;  ///< files read
  std::function<Provenance()> provenance;     ///< of the run, with all options
  LogFormat format = LogFormat::text;         ///< of the line that says so
};

/// Runs `work`. Where it fails for a reason that lies in the program - an internal error, a result
/// that failed its own check - leaves in the folder what whoever mends that needs: copies of the
/// inputs, numbered in their order, and `repro.json` with message, program, versions, options and
/// digests. Not where memory has run out. The error goes on either way.
void with_repro(const Repro& repro, const std::function<void()>& work);

}  // namespace strake
