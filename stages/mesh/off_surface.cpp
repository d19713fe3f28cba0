#include "stages/mesh/off_surface.h"

#include <algorithm>

#include "stages/mesh/cell_shape.h"

namespace strake {
namespace {

/// Price of an edge that is as far off the surface as it is long. One that is a tenth of it off
/// costs as much as corners that are 40 degrees from right angles.
constexpr double kOffPrice = 50;
/// Outlines along which the surface turns less than this are nearly flat.
constexpr double kFlatCosine = 0.8;

}  // namespace

OffSurface::OffSurface(const PolygonGraph& graph, const DartLoop& outline,
                       const EdgeHeights* heights)
    : heights_(heights) {
  if (heights == nullptr) return;
  const Vec3 normal = vector_area(corner_positions(graph, outline)).normalized();
  const bool is_flat = std::ranges::all_of(outline, [&](Index d) {
    return graph.surface_normal(graph.graph().from(d)).dot(normal) >= kFlatCosine;
  });
  if (is_flat) heights_ = nullptr;
}

double OffSurface::price(const Vec3& a, const Vec3& b) const {
  const double length2 = (b - a).squaredNorm();
  if (heights_ == nullptr || !(length2 > 0)) return 0;
  const double height = heights_->at(a, b);
  return kOffPrice * height * height / length2;
}

}  // namespace strake
