#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "common/core/observer.h"
#include "stages/trace/line_tracer.h"

namespace strake {

/// Traces seeds first come, first served, and collects the lines.
class LineCollector {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines; all kept by reference
  LineCollector(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
                const TracerSettings& settings, Observer& observer);

  void add(const TracedLine& line);

  /// Traces these seeds, and all seeds that their lines spawn.
  void grow(const std::vector<Seed>& seeds);

  /// Seeds wherever a direction of the cross has no line within reach.
  void saturate();

  /// Largest distance of a place from the nearest line of each direction of its cross, in wanted
  /// distances, leaving out components that get no lines. Only what no line has covered needs a
  /// look: the rest is nearer than it is covered.
  double largest_gap();

  [[nodiscard]] LineSet& lines() { return lines_; }
  [[nodiscard]] std::size_t tried() const { return tried_; }
  [[nodiscard]] std::int64_t query_count() const { return query_count_; }

 private:
  /// Whether seeds in a face are left to `saturate`, which tries each place once: too many failed.
  [[nodiscard]] bool is_given_up(Index face) const;
  /// Whether no line may start with a seed.
  [[nodiscard]] bool is_left_out(const Seed& seed) const;

  const TraceDomain& domain_;
  TracerSettings settings_;
  std::vector<std::uint8_t> is_of_speck_;  ///< [F]
  FinishedLines finished_;
  LineTracer tracer_;
  Observer& observer_;
  LineSet lines_;
  std::size_t tried_ = 0;
  std::int64_t query_count_ = 0;
  std::int64_t found_queries_ = 0;                          ///< those that lines took
  std::unordered_map<Index, std::int64_t> failed_queries_;  ///< those that costly failures took
  const char* phase_ = "tracing lines";
};

}  // namespace strake
