#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/core/options.h"
#include "common/core/poly_mesh.h"

namespace strake {

/// Surfaces that the program makes itself: known curvature for tests, and a part to try it on.
enum class SampleKind {
  plane,
  sphere,
  cylinder,       ///< closed by flat caps, sharp rims
  open_cylinder,  ///< without caps
  torus,
  ellipsoid,    ///< three different axes
  hyperboloid,  ///< of one sheet, open at both ends
  saddle,       ///< open
  part,         ///< a machined bracket with bores, chamfers, fillets and a rib; genus kPartGenus
};

// Dimensions of the samples. All are centred at the origin, with z as their axis of revolution;
// the part stands on z = 0 and measures 110 x 70 x 52.
inline constexpr double kPlaneHalfSize = 1;       ///< |x|, |y| <= this, z = 0, normal +z
inline constexpr double kSphereRadius = 1;        ///< x^2 + y^2 + z^2 = r^2
inline constexpr double kCylinderRadius = 1;      ///< x^2 + y^2 = r^2 ...
inline constexpr double kCylinderHalfHeight = 1;  ///< ... with |z| <= this
inline constexpr double kTorusMajorRadius = 1;    ///< of the circle along which ...
inline constexpr double kTorusMinorRadius = 0.4;  ///< ... the tube of this radius runs
inline constexpr double kEllipsoidAxes[3] = {1.5, 1.0, 0.7};  ///< (x/a)^2 + (y/b)^2 + (z/c)^2 = 1
inline constexpr double kHyperboloidWaist = 0.5;     ///< a in (x^2 + y^2)/a^2 - (z/c)^2 = 1
inline constexpr double kHyperboloidSlope = 0.6;     ///< c in the same
inline constexpr double kHyperboloidHalfHeight = 1;  ///< |z| <= this; normal away from the axis
inline constexpr double kSaddleBend = 0.5;           ///< s in z = s (x^2 - y^2); normal upwards ...
inline constexpr double kSaddleHalfSize = 1;         ///< ... over |x|, |y| <= this
inline constexpr int kPartGenus = 6;                 ///< four bolt holes, the bore, a cross hole

struct SampleOptions {
  std::int64_t faces = 30000;  ///< wanted; met within 5 % where the design allows (part: from 8000)
  /// Irregularity in [0, 1]: 0 is well-shaped, 1 as bad as triangles may get. Default: 0.25,
  /// for the part 0.
  std::optional<double> jitter;
  std::int64_t seed = 1;  ///< of the jitter

  OptionList declare();
};

/// A sample whose faces say which region of the design they belong to.
struct LabelledSample {
  PolyMesh mesh;
  std::vector<Index> face_region;  ///< [F] one number per smooth analytic piece (part: 35 of them)
};

/// Makes a sample: triangles whose vertices lie on the exact surface, oriented outwards, watertight
/// where the surface is closed, of about equal size (the part: finer on tight bends).
/// Sharp edges, and on the part the borders of flats and fillets too, are chains of mesh edges.
/// \throw UsageError   where an option is out of range
/// \throw AlgorithmError  where a region cannot be triangulated at this resolution
/// Cost O(faces log faces). Same options, same mesh.
PolyMesh make_sample(SampleKind kind, const SampleOptions& options);

/// The same with region labels.
LabelledSample make_labelled_sample(SampleKind kind, const SampleOptions& options);

/// All kinds by name, in the order of the enumeration.
const std::vector<std::string>& sample_names();

/// \throw UsageError naming the known ones where there is no such sample
SampleKind sample_kind(std::string_view name);

}  // namespace strake
