#pragma once

#include <optional>
#include <set>
#include <string>
#include <vector>

#include "common/artifact/store/known_digests.h"
#include "common/artifact/store/store.h"
#include "strake/run/plan.h"

namespace strake {

/// How a step stands before a run.
struct StepState {
  enum class Status {
    cached,    ///< its artifact is in the store
    stale,     ///< has to be run
    unneeded,  ///< a part of something that is in the store whole
  };
  Status status = Status::stale;
  std::optional<std::string> key;  ///< known where the inputs are
  std::optional<Entry> entry;      ///< where there is an artifact
  std::string reason;              ///< why the status is what it is
  bool damaged = false;            ///< there is an artifact, but not a sound one
  bool forced = false;             ///< wanted anew, whatever is in the store
};

/// Where the store has a step's artifact. \pre its key is known
EntryName entry_name(const Step& step, const StepState& state);

/// Compares a plan with the store. Reads the bytes of files only where their stamps have changed.
/// \param forced  ids of steps that are stale whatever is in the store
/// \param check   how closely to look at what is in the store
/// \return one state per step
/// \throw InputError where a model file cannot be read
std::vector<StepState> survey(const Plan& plan, const Store& store, KnownDigests& digests,
                              const std::set<std::string>& forced, Store::Check check);

/// Files that the user wants and that are not there or not up to date, of steps whose artifact is.
struct PendingDelivery {
  std::size_t step = 0;
  std::string file;
};
std::vector<PendingDelivery> pending_deliveries(const Plan& plan,
                                                const std::vector<StepState>& states,
                                                KnownDigests& digests);

/// Files that the user wants and that running all that is stale will make or bring up to date.
std::vector<std::string> files_to_write(const Plan& plan, const std::vector<StepState>& states,
                                        KnownDigests& digests);

/// The path from the working folder where it is below it, for messages.
std::string shown_path(const std::filesystem::path& file);

/// Copies an artifact to a file the user wants; the file appears whole or not at all.
/// \throw InputError naming the artifact where it has gone, else both
void deliver(const std::filesystem::path& artifact, const std::filesystem::path& file);

}  // namespace strake
