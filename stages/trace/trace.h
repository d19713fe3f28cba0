#pragma once

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/observer.h"
#include "common/core/options.h"
#include "common/core/report.h"
#include "common/core/tri_mesh.h"

namespace strake {

struct TraceOptions {
  std::optional<Length> tolerance;       ///< approximation tolerance; default 0.1 %
  std::optional<std::int64_t> vertices;  ///< wanted vertex count instead of a tolerance
  std::optional<std::int64_t> faces;     ///< wanted face count instead of a tolerance
  /// Factor on all spacings. Without it, lines for a count are traced again until they give it.
  std::optional<double> spacing_scale;
  /// Cap on the distance between lines; default: 5 % up to a tolerance of 0.1 %, growing with its
  /// root beyond, or three mean cells where a count is wanted.
  std::optional<Length> max_spacing;
  /// Lines stop at this share of the wanted distance; default: 0.45, with a density 0.6.
  std::optional<double> stop_fraction;
  double line_flow = 5;   ///< cells over which distances follow lines that part or converge
  std::int64_t seed = 1;  ///< of the random generator that places the first seeds

  OptionList declare();
};

/// What may be known of the distances between lines beside the options; nullptr: nothing.
struct WantedSizes {
  const SizeField* size = nullptr;        ///< to take instead of a tolerance and the curvature
  const DensityField* density = nullptr;  ///< distances shrink with its root; not used with `size`,
                                          ///< which was made from distances that know it
};

struct TraceResult {
  LineSet lines;
  Report report;
};

/// Covers the surface with lines of minimum and maximum curvature, boundary and feature lines.
/// Paper: [MK04] sections 3 and 4.2. Deterministic for any thread count.
/// \throw UsageError where more than one of tolerance and counts is given, PreconditionError where
///        the density is of another mesh
TraceResult trace_lines(const TriMesh& mesh, const PrincipalField& field,
                        const TraceOptions& options, Observer& observer,
                        const WantedSizes& sizes = {});

}  // namespace strake
