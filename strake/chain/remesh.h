#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/core/edge_list.h"
#include "common/core/fields.h"
#include "common/core/guides.h"
#include "common/core/poly_mesh.h"
#include "common/core/report.h"
#include "common/core/stage_observer.h"
#include "common/core/tri_mesh.h"
#include "stages/coarsen/coarsen.h"
#include "stages/decimate/decimate.h"
#include "stages/evaluate/evaluate.h"
#include "stages/fit/fit.h"
#include "stages/import/import.h"
#include "stages/mesh/mesh.h"
#include "stages/refine/refine.h"
#include "stages/refine/worst.h"
#include "stages/size/size.h"
#include "stages/smooth/smooth.h"
#include "stages/tensor/tensor.h"
#include "stages/trace/trace.h"

namespace strake {

/// What to remesh. Only `mesh` is needed.
struct RemeshInput {
  PolyMesh mesh;                ///< polygons, also with defects: they are repaired and counted
  EdgeList feature_edges;       ///< edges of `mesh` to keep besides those that bend
  GuideLines guides;            ///< lines on or near the surface along which edges are to run
  std::vector<double> density;  ///< [V] positive: wanted vertices per area, relative to what they
                                ///< would be without; empty: everywhere alike
};

/// The options of every stage, each with its default. At most one goal among `trace.tolerance`,
/// `trace.vertices` and `trace.faces`; without one, spacing is that for a tolerance of 0.1 %.
struct RemeshOptions {
  ImportOptions import;
  TensorOptions tensor;
  SmoothOptions smooth;
  CoarsenOptions coarsen;  ///< `vertices` follows from the goal
  TraceOptions trace;
  MeshOptions mesh;
  FitOptions fit;
  SizeOptions size;
  RefineOptions refine;  ///< `tolerance` and `vertices` follow from the goal
  WorstOptions worst;
  DecimateOptions decimate;  ///< likewise
  EvaluateOptions evaluate;  ///< `tolerance` follows from the goal where it is not given
  /// Times that lines are traced again by errors measured, where there is a goal; default: 1, with
  /// a density and a count as many as it takes.
  std::optional<std::int64_t> feedback_rounds;
  /// Keep the result of lines also where they are too coarse for the shape at a wanted count, and
  /// decimating it does much better.
  bool lines_only = false;
  /// Vertices per wanted vertex of the coarser mesh on which lines are traced where the input has
  /// more than twice as many; 0: always on the input.
  double working_ratio = 10;
  bool measure = true;  ///< measure the result against the input at the end

  /// All of them as declared; their names are those of the command line. They point into this
  /// object.
  OptionList declare();
};

struct RemeshResult {
  QuadMesh quads;        ///< in the coordinates of the input
  TriMesh mesh;          ///< the input as repaired, which `quads.provenance` speaks of
  PrincipalField field;  ///< of `mesh`: the directions that edges follow
  std::vector<std::pair<std::string, Report>>
      reports;                        ///< by stage, in order; the last run of each
  std::vector<std::string> messages;  ///< for a user: warnings, and how near a count came
};

/// Remeshes a surface with quads along its curvature: all stages, and those from tracing on as
/// often as the goal takes. What `strake remesh` does between reading and writing.
///
/// Uses as many threads as oneTBB gives it, and gives the same bytes for any number.
/// \param observer  is told of every stage (`begin`), phase and message; cancels by throwing
/// \throw UsageError where an option is out of range or there is more than one goal, InputError
///        where the mesh has no usable surface, AlgorithmError where the result failed its own
///        check, ToleranceError where the tolerance was not reached, and what the observer throws
RemeshResult remesh(RemeshInput input, const RemeshOptions& options, StageObserver& observer);

/// As above, telling nobody.
RemeshResult remesh(RemeshInput input, const RemeshOptions& options = {});

}  // namespace strake
