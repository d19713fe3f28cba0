#pragma once

#include "common/geometry/samples/samples.h"
#include "common/geometry/samples/surface_builder.h"

namespace strake {

/// Draws the curves and patches of an analytic sample for a wanted edge length.
void design_analytic(SampleKind kind, double size, SurfaceBuilder& builder);

/// The same for the part. Tight bends are made finer than `size` where they need it.
void design_part(double size, SurfaceBuilder& builder);

/// A circle in the plane z = `height` of a frame, as a curve.
SurfaceBuilder::CurveFunction circle_curve(const Frame& frame, double radius, double height);

}  // namespace strake
