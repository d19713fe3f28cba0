#include "stages/trace/finished_lines.h"

#include "stages/trace/line_tracer.h"

namespace strake {

void FinishedLines::add(const LineDraft& draft, Index line) {
  for (const CoveredDisc& disc : draft.covered) coverage_.mark(disc, walk_);
  if (!draft.is_line) return;
  proximity_.insert(draft.segments, line);
  if (draft.line.end_reason == LineEnd::closed) rings_.insert(line);
}

}  // namespace strake
