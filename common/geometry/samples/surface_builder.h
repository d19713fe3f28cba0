#pragma once

#include <array>
#include <functional>
#include <vector>

#include "common/core/types.h"
#include "common/geometry/samples/charted_surface.h"
#include "common/geometry/samples/random.h"

namespace strake {

/// A triangulation in the making: vertices on exact surfaces, and edges that stay.
struct SurfaceDraft {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> faces;
  std::vector<Index> face_region;                     ///< [F]
  std::vector<const ChartedSurface*> vertex_surface;  ///< [V] surface to slide on; nullptr: fixed
  std::vector<std::array<Index, 2>> locked;  ///< edges (smaller vertex first), sorted, unique
  std::vector<SurfacePtr> surfaces;          ///< owners of `vertex_surface`
};

/// Builds a surface from smooth patches between curves that neighbours share.
class SurfaceBuilder {
 public:
  using CurveFunction = std::function<Vec3(double)>;  ///< over [0, 1]

  /// \param curve_jitter  irregularity of the spacing along curves, in [0, 1]
  SurfaceBuilder(double curve_jitter, std::uint64_t seed)
      : curve_jitter_(curve_jitter), random_(seed) {}

  Index add_corner(const Vec3& position);
  /// Samples a curve between two corners at about `spacing` apart. \return the curve
  Index add_curve(Index from, Index to, const CurveFunction& at, double spacing);
  /// Samples a closed curve.
  Index add_loop(const CurveFunction& at, double spacing);
  /// A closed curve that separates two patches of one surface and leaves no trace in the mesh: its
  /// points are scattered about it and stay free.
  Index add_seam(const CurveFunction& at, double spacing, const SurfacePtr& surface);

  /// Triangulates the region of a surface that the curves enclose.
  /// \param size  wanted edge length; finer beside curves that are sampled more finely
  /// \throw AlgorithmError where the curves are too coarse for the region between them
  void add_patch(const SurfacePtr& surface, double size, const std::vector<Index>& curves,
                 Index region);

  /// Hands out the result; the builder is empty afterwards.
  SurfaceDraft finish();

 private:
  struct Curve {
    std::vector<Index> vertices;
    bool closed = false;
    bool locked = true;
  };

  Index add_vertex(const Vec3& position, double size);
  Curve sample(const CurveFunction& at, double spacing, bool closed, Index from, Index to);

  double curve_jitter_;
  UniformRandom random_;
  std::vector<Curve> curves_;
  std::vector<double> vertex_size_;
  SurfaceDraft draft_;
};

}  // namespace strake
