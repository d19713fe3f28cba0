#include "stages/trace/line_collector.h"

#include <algorithm>
#include <deque>

#include "stages/trace/specks.h"

namespace strake {
namespace {

/// Queries that failed lines from one face may cost, beside those of all lines found. Of 160 real
/// meshes one took 51,000, the others below 10,000; a face that is hundreds of line distances long,
/// where lines end before they cross two edges, would go on a thousand times as long.
constexpr std::int64_t kMostFailedQueries = 100'000;
constexpr std::int64_t kCostlyDraft = 256;  ///< queries from which a failed line is counted

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
    : domain_(domain),
      settings_(settings),
      is_of_speck_(faces_of_specks(domain.mesh, domain.spacing)),
      finished_(domain, barriers),
      tracer_(domain, barriers, settings, finished_),
      observer_(observer) {}

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

void LineCollector::grow(const std::vector<Seed>& seeds) {
  std::deque<Seed> queue(seeds.begin(), seeds.end());
  while (!queue.empty()) {
    const Seed seed = queue.front();
    queue.pop_front();
    if (is_left_out(seed)) continue;
    const LineDraft draft = tracer_.trace(seed);
    query_count_ += draft.query_count;
    // Also while gaps are filled, so that a run can be interrupted at any time.
    if (++tried_ % 64 == 0) observer_.report(phase_, finished_.coverage().covered_share());
    finished_.add(draft, lines_.line_count());
    if (!draft.is_line) {
      if (draft.query_count >= kCostlyDraft) failed_queries_[seed.face] += draft.query_count;
      continue;
    }
    found_queries_ += draft.query_count;
    add(draft.line);
    queue.insert(queue.end(), draft.spawned.begin(), draft.spawned.end());
  }
  finished_.mark_covered();
}

bool LineCollector::is_given_up(Index face) const {
  const auto failed = failed_queries_.find(face);
  return failed != failed_queries_.end() && failed->second > kMostFailedQueries + found_queries_;
}

bool LineCollector::is_left_out(const Seed& seed) const {
  return is_of_speck_[seed.face] != 0 || (!seed.fills_gap && is_given_up(seed.face));
}

void LineCollector::saturate() {
  phase_ = "filling gaps";
  finished_.coverage().for_gaps([&](const Coverage::Gap& gap) {
    const Seed seed = seed_of(gap);
    if (is_left_out(seed)) return;
    const Index before = lines_.line_count();
    tracer_.proximity().clear();
    grow({centred(domain_, seed, tracer_.proximity())});
    if (lines_.line_count() == before) grow({seed});  // in the middle there may be no room for one
  });
}

double LineCollector::largest_gap() {
  ProximityProbe& proximity = tracer_.proximity();
  proximity.clear();
  double largest = settings_.cover_fraction;
  finished_.coverage().for_gaps([&](const Coverage::Gap& gap) {
    if (is_of_speck_[gap.face] != 0) return;
    const LineHead head = start_head(domain_, seed_of(gap), true);
    largest = std::max(largest, share_to_nearest(domain_, head, proximity));
  });
  return largest;
}

}  // namespace strake
