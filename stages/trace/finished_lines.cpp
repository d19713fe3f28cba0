#include "stages/trace/finished_lines.h"

#include <tbb/parallel_for.h>

#include "stages/trace/line_tracer.h"

namespace strake {
namespace {

constexpr std::size_t kMostToMark = 4096;  ///< discs that wait

}  // namespace

void FinishedLines::add(const LineDraft& draft, Index line) {
  to_mark_.insert(to_mark_.end(), draft.covered.begin(), draft.covered.end());
  if (to_mark_.size() >= kMostToMark) mark_covered();
  if (!draft.is_line) return;
  proximity_.insert(draft.segments, line);
  if (draft.line.end_reason == LineEnd::closed) rings_.insert(line);
}

void FinishedLines::mark_covered() {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, to_mark_.size(), 64),
                    [&](const auto& range) {
                      BlockWalk& walk = walks_.local();
                      for (std::size_t i = range.begin(); i < range.end(); ++i) {
                        coverage_.mark(to_mark_[i], walk);
                      }
                    });
  to_mark_.clear();
}

}  // namespace strake
