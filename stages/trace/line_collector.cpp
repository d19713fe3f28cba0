#include "stages/trace/line_collector.h"

#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <utility>

namespace strake {
namespace {

/// Seeds that may be traced before their turn. Most are refused at once.
constexpr std::size_t kMostAhead = 256;
/// Lines among them for each thread: enough to keep it busy while others trace long ones, and few
/// enough that most of them can stay.
constexpr std::size_t kLinesAhead = 1;

Seed seed_of(const Coverage::Gap& gap) {
  Seed seed;
  seed.face = gap.face;
  seed.barycentric = gap.barycentric;
  seed.direction = gap.direction;
  seed.fills_gap = true;
  return seed;
}

}  // namespace

LineCollector::LineCollector(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                             const TracerSettings& settings, Observer& observer)
    : domain_(domain), settings_(settings), finished_(domain, barriers), observer_(observer) {
  const std::size_t threads =
      tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  for (std::size_t i = 0; i < threads; ++i) {
    tracers_.push_back(
        std::make_unique<LineTracer>(domain, barriers, settings, finished_, threads > 1));
  }
}

void LineCollector::add(const TracedLine& line) {
  lines_.points.insert(lines_.points.end(), line.points.begin(), line.points.end());
  lines_.chord_face.insert(lines_.chord_face.end(), line.chord_face.begin(), line.chord_face.end());
  lines_.chord_family.insert(lines_.chord_family.end(), line.chord_family.begin(),
                             line.chord_family.end());
  lines_.seed_point.push_back(lines_.offsets.back() + line.seed_point);
  lines_.offsets.push_back(static_cast<Index>(lines_.points.size()));
  lines_.family.push_back(line.family);
  lines_.start_reason.push_back(line.start_reason);
  lines_.end_reason.push_back(line.end_reason);
}

/// Traces the first seed of the queue and, with several threads, some after it. How many does not
/// matter to the result.
void LineCollector::trace_ahead(std::deque<Entry>& queue) {
  const std::size_t threads = tracers_.size();
  const std::size_t ahead = std::min(queue.size(), threads > 1 ? kMostAhead : 1);
  const Index since = finished_.proximity().segment_count();
  std::atomic<std::size_t> next = 0;
  std::atomic<std::size_t> lines = 0;
  const auto work = [&](std::size_t thread) {
    while (lines < kLinesAhead * threads) {
      const std::size_t i = next++;
      if (i >= ahead) return;
      Entry& entry = queue[i];
      if (!entry.is_traced) {
        entry.draft = tracers_[thread]->trace(entry.seed);
        entry.since = since;
        entry.is_traced = true;
      }
      if (entry.draft.is_line) ++lines;
    }
  };
  if (ahead == 1) {
    work(0);
  } else {
    tbb::parallel_for(std::size_t{0}, threads, work, tbb::simple_partitioner());
  }
}

void LineCollector::finish(const LineDraft& draft, std::deque<Entry>& queue) {
  // Also while gaps are filled, so that a run can be interrupted at any time.
  if (++tried_ % 64 == 0) observer_.report(phase_, finished_.coverage().covered_share());
  query_count_ += draft.query_count;
  finished_.add(draft, lines_.line_count());
  if (!draft.is_line) return;
  add(draft.line);
  for (const Seed& seed : draft.spawned) queue.push_back({seed, false, 0, {}});
}

void LineCollector::grow(const std::vector<Seed>& seeds) {
  std::deque<Entry> queue;
  for (const Seed& seed : seeds) queue.push_back({seed, false, 0, {}});
  while (!queue.empty()) {
    trace_ahead(queue);
    while (!queue.empty() && queue.front().is_traced) {
      Entry entry = std::move(queue.front());
      queue.pop_front();
      if (finished_.proximity().has_news(entry.draft.asked, entry.since)) {
        queue.push_front({entry.seed, false, 0, {}});
        break;
      }
      finish(entry.draft, queue);
    }
  }
}

void LineCollector::saturate() {
  phase_ = "filling gaps";
  for (Index f = 0; f < domain_.mesh.face_count(); ++f) {
    finished_.coverage().for_gaps(f, [&](const Coverage::Gap& gap) {
      tracers_.front()->proximity().clear();
      grow({centred(domain_, seed_of(gap), tracers_.front()->proximity())});
    });
  }
}

double LineCollector::largest_gap() {
  ProximityProbe& proximity = tracers_.front()->proximity();
  proximity.clear();
  double largest = settings_.cover_fraction;
  for (Index f = 0; f < domain_.mesh.face_count(); ++f) {
    finished_.coverage().for_gaps(f, [&](const Coverage::Gap& gap) {
      const LineGap beside =
          gap_beside(domain_, start_head(domain_, seed_of(gap), true), proximity);
      largest = std::max(largest, std::min(beside.to_left, beside.to_right) / beside.wanted);
    });
  }
  return largest;
}

}  // namespace strake
