#pragma once

#include <array>

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

  [[nodiscard]] bool is_anchored() const { return anchor.halfedge != kNone; }
};

/// The moving end of a line.
struct LineHead {
  FieldContext context;
  Vec2 point = Vec2::Zero();                     ///< chart
  Vec2 heading = Vec2::Zero();                   ///< chart, unit
  Vec2 trusted = Vec2::Zero();                   ///< chart, average of the last reliable headings
  std::array<Index, 2> closed = {kNone, kNone};  ///< half-edges that are no way out of the face
  LineFamily family = LineFamily::minimum;
  bool was_reliable = true;
  double arc = 0;            ///< length from the seed
  double sign = 1;           ///< -1 on the backward half
  bool from_corner = false;  ///< whether the line starts at a vertex
  LinePoint last;            ///< last recorded point; halfedge kNone while in the seed's face
  Vec3 last_position;        ///< world, of `last` or the seed
};

/// The head of the forward or backward half of a line, along the arm of the field closest to the
/// seed's direction.
LineHead start_head(const TraceDomain& domain, const Seed& seed, bool forward);

/// Wanted distances where a head is, for the way it goes.
inline LocalSpacing spacing_at(const TraceDomain& domain, const LineHead& head) {
  return spacing_at(domain, head.context, head.point, head.heading);
}

/// Moves a point along a straight geodesic, up to the first barrier.
/// \param closed half-edges of the first face that are no way out
void walk_straight(const TraceDomain& domain, const Vec2& displacement, std::array<Index, 2> closed,
                   FieldContext& context, Vec2& point);

/// Direction of a fourth-order Runge-Kutta step of this length from a head ([MK04] section 3.1).
Vec2 runge_kutta(const TraceDomain& domain, const LineHead& head, double step);

}  // namespace strake
