#pragma once

#include <chrono>
#include <set>
#include <string>
#include <vector>

#include "strake/run/run_folder.h"

namespace strake {

/// Tells on stderr how a run goes: a line per step that ends; what is running as a block that is
/// redrawn on a terminal, and as a line every ten seconds elsewhere.
class RunDisplay {
 public:
  /// \param quiet  say nothing but what failed
  RunDisplay(const RunFolder& folder, const std::vector<StepOrder>& orders, bool quiet);

  /// Looks at the run folder and shows what is new.
  void update();
  /// Shows what is left to show and takes the block away.
  void finish();

 private:
  enum class Stopped { may_go_on, have_ended };  ///< steps that are interrupted

  void show_ended(Stopped steps);
  void show_running();
  void clear_block();

  const RunFolder& folder_;
  const std::vector<StepOrder>& orders_;
  bool quiet_;
  bool terminal_;
  std::set<std::string> ended_;
  std::size_t block_lines_ = 0;
  std::chrono::steady_clock::time_point last_shown_;
};

/// The steps of a run as a table: title, what became of it, time, peak memory. Steps that were
/// never started are listed as such.
std::string run_table(const RunFolder& folder, const std::vector<StepOrder>& orders);

}  // namespace strake
