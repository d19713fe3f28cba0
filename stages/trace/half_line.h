#pragma once

#include <vector>

#include "stages/trace/line_head.h"
#include "stages/trace/line_seeding.h"
#include "stages/trace/proximity.h"

namespace strake {

/// Crossings nearer to a vertex than this share of the edge pass through the vertex.
inline constexpr double kVertexTolerance = 1e-3;

/// The next piece of a line.
struct Chord {
  LinePoint to;
  Index face = kNone;
  Vec3 direction;  ///< world; of the line, since short chords may point anywhere
};

/// What one half of a line has recorded so far, from its seed on.
struct HalfLine {
  HalfLine(const TraceDomain& domain, const LineHead& start)
      : origin(start.last),
        seed_face(start.context.chart.face),
        seed_position(start.last_position),
        seed_direction(world_direction(domain, start.context, start.heading)) {}

  std::vector<LinePoint> points;
  std::vector<Index> faces;  ///< of the chord that leads to each point
  std::vector<LineFamily> families;
  std::vector<double> arcs;  ///< length the head had gone at each point
  LineEnd end = LineEnd::stuck;
  Index stopped_by = kNone;  ///< the line it came too close to; kNone for none, or a barrier,
                             ///< kOwnLine for itself
  CrossingSeeds crossings;   ///< seeds of lines that cross this one
  LinePoint origin;          ///< the seed's anchor; halfedge kNone where it has none
  Index seed_face = kNone;
  Vec3 seed_position;
  Vec3 seed_direction;  ///< world, as the half starts
};

/// Moves heads over the surface, recording where they cross edges.
///
/// Every recorded chord is one segment of the probe, so that what was recorded last can
/// be taken back.
class LineWalker {
 public:
  /// \param barriers [3F] half-edges of feature and boundary lines; kept by reference
  LineWalker(const TraceDomain& domain, const std::vector<std::uint8_t>& barriers,
             ProximityProbe& proximity)
      : domain_(domain), barriers_(barriers), proximity_(proximity) {}

  /// Moves the head along a straight geodesic; false where the line ends, with `half.end` set.
  ///
  /// A head that turns back through the edge it came in by undoes that crossing.
  bool advance(LineHead& head, Vec2 displacement, HalfLine& half);

  /// Appends a chord from the last point, or from the seed.
  /// \pre head.arc is that of the chord's end
  void record(LineHead& head, const Chord& chord, HalfLine& half);

  /// Takes back the `count` points recorded last.
  void take_back(LineHead& head, std::size_t count, HalfLine& half);

 private:
  bool turn_back(LineHead& head, Index h, HalfLine& half);
  bool pass_vertex(LineHead& head, Index corner, const Vec2& direction, HalfLine& half);
  bool pass_feature(LineHead& head, Index h, HalfLine& half);
  void enter(LineHead& head, Index h);

  const TraceDomain& domain_;
  const std::vector<std::uint8_t>& barriers_;
  ProximityProbe& proximity_;
};

}  // namespace strake
