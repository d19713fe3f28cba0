#pragma once

#include <boost/container/small_vector.hpp>

#include "common/core/types.h"
#include "stages/mesh/polygon_graph.h"

namespace strake {

/// Corners of a cell in order, counter-clockwise seen from outside.
using Polygon = boost::container::small_vector<Vec3, 8>;

Polygon corner_positions(const PolygonGraph& graph, const DartLoop& cell);

/// The vector area of a polygon (Newell).
Vec3 vector_area(const Polygon& p);

/// Twice the area of a flat triangle, negative where it turns clockwise.
inline double turn(const Vec2& a, const Vec2& b, const Vec2& c) {
  return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

/// Whether two segments have a point in common; of two on one straight line it says so always.
inline bool segments_meet(const Vec2& a, const Vec2& b, const Vec2& c, const Vec2& d) {
  return turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0;
}

/// Interior angle at corner i, in [0, 2 pi), seen along the unit normal n.
double interior_angle(const Polygon& p, std::size_t i, const Vec3& n);

/// Whether a corner turns against the unit normal of the polygon: the measure of concavity.
bool is_reflex(const Polygon& p, std::size_t i, const Vec3& n);

/// Penalty of a face: squared deviation of its corners from right angles in rad^2, mean over the
/// corners, with extra for reflex corners and for other shapes than quads ([MK04] section 5.2
/// scores by right angles). Infinite where it is thin as a line or turned against `surface_normal`.
double shape_penalty(const Polygon& p, const Vec3& surface_normal);

}  // namespace strake
