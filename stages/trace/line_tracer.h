#pragma once

#include <vector>

#include "stages/trace/coverage.h"
#include "stages/trace/proximity.h"
#include "stages/trace/sampling.h"

namespace strake {

/// Where a line starts: inside a face, on a feature or boundary edge, or at a vertex.
struct Seed {
  Index face = kNone;
  Vec3 barycentric = Vec3::Constant(1.0 / 3);
  Vec3 direction;    ///< world; the line takes the closest arm of the field
  LinePoint anchor;  ///< edge or vertex point the line starts from; halfedge kNone inside a face
  bool fills_gap =
      false;  ///< not at its wanted distance from another line, but where one is missing
};

/// A finished line, in the representation of LineSet.
struct TracedLine {
  std::vector<LinePoint> points;
  std::vector<Index> chord_face;         ///< [P] face of the chord to the next point
  std::vector<LineFamily> chord_family;  ///< [P]
  LineFamily family = LineFamily::minimum;
  LineEnd start_reason = LineEnd::stuck;
  LineEnd end_reason = LineEnd::stuck;
  Index seed_point = 0;
};

struct TracerSettings {
  double stop_fraction = 0.5;   ///< of the wanted distance, below which a line stops
  double seed_fraction = 0.8;   ///< of the wanted distance, below which a seed is refused
  double gap_fraction = 0.95;   ///< likewise, for seeds that fill gaps
  double cover_fraction = 0.9;  ///< of the wanted distance, within which a point counts as covered
};

/// Traces lines one by one and keeps what later lines must respect ([MK04] sections 3 and 4.2).
class LineTracer {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines; kept by reference
  LineTracer(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
             const TracerSettings& settings);

  /// Traces the line of a seed in both directions.
  /// \param spawned receives seeds for lines that cross this one, at their wanted distances
  /// \return false where the seed is too close to a line of its direction, or the line too short
  bool trace(const Seed& seed, Index line, TracedLine& result, std::vector<Seed>& spawned);

  /// The seed moved sideways into the middle between the lines of its direction beside it, or to
  /// the wanted distance from the only one: lines that fill gaps are then as even as possible.
  [[nodiscard]] Seed centred(const Seed& seed);

  [[nodiscard]] const Coverage& coverage() const { return coverage_; }
  [[nodiscard]] std::uint64_t query_count() const { return proximity_.query_count(); }

 private:
  struct Head;
  struct HalfLine;

  Head start_head(const Seed& seed, bool forward) const;
  bool fits(const Head& head, double fraction);
  std::pair<double, double> gap_beside(const Head& head, double reach);
  ProximityHit look_around(const Head& head, double fraction, const LocalSpacing& spacing);
  void cover(const Head& head, const LocalSpacing& spacing);
  void note_candidate(Head& head, const LocalSpacing& spacing, double step, HalfLine& half) const;
  static void spawn(const HalfLine& half, std::vector<Seed>& spawned);
  void trace_half(Head head, bool may_close, HalfLine& half);
  void walk_straight(const Vec2& displacement, std::array<Index, 2> closed, FieldContext& context,
                     Vec2& point) const;
  Vec2 runge_kutta(const Head& head, double step) const;
  bool advance(Head& head, Vec2 displacement, HalfLine& half);
  bool pass_vertex(Head& head, Index corner, const Vec2& direction, HalfLine& half);
  bool pass_feature(Head& head, Index h, HalfLine& half);
  bool record(Head& head, const LinePoint& point, const Vec2& at, HalfLine& half);
  bool try_close(const Head& head, const LocalSpacing& spacing, double least_cosine,
                 HalfLine& half);
  bool join(const HalfLine& forward, const HalfLine& backward, const Seed& seed,
            TracedLine& result) const;

  const TraceDomain& domain_;
  const std::vector<std::uint8_t>& barriers_;
  TracerSettings settings_;
  ProximityIndex proximity_;
  Coverage coverage_;
};

}  // namespace strake
