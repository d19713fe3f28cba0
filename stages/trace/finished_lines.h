#pragma once

#include <tbb/enumerable_thread_specific.h>

#include <unordered_set>
#include <vector>

#include "stages/trace/coverage.h"
#include "stages/trace/proximity.h"

namespace strake {

struct LineDraft;

/// What finished lines leave behind for those that are traced later.
class FinishedLines {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines; all kept by reference
  FinishedLines(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers)
      : blocks_(domain.mesh, domain.spacing, barriers),
        proximity_(blocks_, barriers),
        coverage_(domain, blocks_),
        walks_([this] { return BlockWalk(blocks_); }) {}
  FinishedLines(const FinishedLines&) = delete;  // its parts hold references to each other
  FinishedLines& operator=(const FinishedLines&) = delete;

  /// Adds what came of a seed. \param line  its number, where it is a line
  void add(const LineDraft& draft, Index line);
  /// Marks what has been covered by all that was added, which may wait until then.
  void mark_covered();

  [[nodiscard]] const ProximityIndex& proximity() const { return proximity_; }
  [[nodiscard]] const Coverage& coverage() const { return coverage_; }
  /// Whether a line is closed.
  [[nodiscard]] bool is_ring(Index line) const { return rings_.contains(line); }

 private:
  FaceBlocks blocks_;
  ProximityIndex proximity_;
  Coverage coverage_;
  tbb::enumerable_thread_specific<BlockWalk> walks_;
  std::vector<CoveredDisc> to_mark_;
  std::unordered_set<Index> rings_;
};

}  // namespace strake
