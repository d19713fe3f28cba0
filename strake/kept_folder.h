#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/stage/program.h"
#include "common/stage/stage.h"
#include "strake/chain/session.h"

namespace strake {

/// The folder in which `strake remesh --keep` keeps each output as "port.hdf", each record as
/// "stage.json", and the times of all stages as times.json: reports and artifacts hold none, for
/// equal work to give equal bytes.
class KeptFolder {
 public:
  KeptFolder(std::filesystem::path folder, std::vector<const Stage*> stages);

  /// \param others  files of the same command
  /// \throw UsageError where one of them would be replaced, or the folder holds files of such names
  ///        that no run kept there
  void check(const std::vector<NamedFile>& others) const;

  /// Makes the folder. What an earlier run kept there stays until there is something to keep, and
  /// goes altogether then: another one may have other stages.
  /// \throw InputError where it cannot be made
  [[nodiscard]] Session::Keeper keeper() const;

  /// Removes what was kept of attempts that came to nothing and contradicts the other files: no
  /// artifact is left beside another one than it was made from.
  /// \param port  of the result; what led to it stays
  void end(const std::string& port) const;

 private:
  [[nodiscard]] std::filesystem::path times() const { return folder_ / "times.json"; }
  /// Whether the folder has the times of a run, so that the files of stages are of that run.
  [[nodiscard]] bool is_kept() const;
  /// Those of stages.
  [[nodiscard]] std::vector<std::filesystem::path> files() const;

  std::filesystem::path folder_;
  std::vector<const Stage*> stages_;
};

}  // namespace strake
