#include "strake/chain/line_steps.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "common/core/fields.h"
#include "common/core/line_set.h"
#include "common/core/number_text.h"
#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"
#include "common/geometry/mesh_measures.h"
#include "stages/size/closer_near.h"

namespace strake {
namespace {

/// Vertices that lines give at distances that follow errors, over those at even ones where as many
/// are expected. The mean of 34 models and counts; it saves a trial in every other run.
constexpr double kFeedbackExcess = 1.04;
/// The same where no count scales them, as distances that differ more are evened out more: the mean
/// of 19 models.
constexpr double kEvenExcess = 1.25;
/// Error of cells at which lines aim before cells are divided, as a share of the tolerance. It is
/// between the mean of a cell and its largest one, and fitting lowers it. At 0.6 more cells are
/// divided, which leaves fewer quads; at less there are more vertices.
constexpr double kAimedAt = 0.45;
/// Scale on distances that were those of lines, and have theirs in them: none. Where a count is
/// wanted the stage scales them to it first, and the scale found for that stays.
constexpr const char* kScaleOfLines = "";
/// Rounds of fitting before the worst cells are divided: enough to see where errors will stay.
constexpr int kRoundsBeforeDividing = 3;

/// Wants other distances between lines where the present result is too far from the surface.
///
/// Errors are those of vertices on the surface: where they are large they stay so when vertices
/// are fitted.
/// \return root mean square of the distance, model units
double want_by_errors(Session& session, const GoalStages& stages) {
  session.provide_as("fitted", session.get<QuadMesh>("quads"), "quads");
  return session.run(stages.size).number("size.rms").value_or(0);
}

/// Cells that lines at these distances have between them, about.
double cells_at(const TriMesh& mesh, const SizeField& distances) {
  const std::vector<double> areas = wedge_areas(mesh);
  double sum = 0;
  for (std::size_t w = 0; w < areas.size(); ++w) {
    sum += areas[w] / (distances.along[w] * distances.across[w]);
  }
  return sum;
}

/// Wants lines closer around some places. \param wanted  see `closer_near`
void want_closer(Session& session, const SizeField& wanted, const std::vector<Vec3>& places,
                 double factor) {
  const SizeField used = used_distances(session.get<LineSet>("lines"));
  session.provide("size", closer_near(session.get<TriMesh>("mesh"), wanted, used, places, factor),
                  "closer lines", "");
}

}  // namespace

void trace_anew(Session& session, const GoalStages& stages) {
  // Earlier results make room for those that take their place.
  for (const char* port : {"lines", "quads", "fitted", "refined", "uncrossed"})
    session.withdraw(port);
  session.run(stages.trace);
}

void trace_and_mesh(Session& session, const GoalStages& stages) {
  trace_anew(session, stages);
  session.run(stages.mesh);
}

LineLoad load_of(const TriMesh& mesh, const LineSet& lines) {
  LineLoad load;
  std::vector<std::array<std::int64_t, 2>> chords(mesh.face_count());
  for (std::size_t i = 0; i < lines.points.size(); ++i) {
    const LineFamily family = lines.chord_family[i];
    if (family != LineFamily::minimum && family != LineFamily::maximum) continue;
    if (mesh.is_barrier(lines.points[i].halfedge)) ++load.nodes;
    if (lines.chord_face[i] == kNone) continue;
    ++chords[lines.chord_face[i]][family == LineFamily::minimum ? 0 : 1];
  }
  for (const auto& [along, across] : chords) {
    load.nodes += along * across;
    load.fullest_face = std::max({load.fullest_face, along, across});
  }
  return load;
}

void mesh_with_strips(Session& session, const GoalStages& stages, const LineAim& aim) {
  const std::int64_t missing = aim.count - count_of(session, "quads", aim.counted);
  // A strip has about as many quads as rungs.
  const OtherValue vertices(
      stages.mesh.option("strip-vertices"),
      std::to_string(count_of(session, "quads", Counted::vertices) + missing));
  session.run(stages.mesh);
}

void keep_fitted(Session& session, const GoalStages& stages) {
  for (const Stage* stage : {&stages.trace, &stages.mesh, &stages.fit}) session.keep(*stage);
}

void trace_mesh_and_fit(Session& session, const GoalStages& stages) {
  trace_and_mesh(session, stages);
  session.run(stages.fit);
  keep_fitted(session, stages);
}

void fit_before_dividing(Session& session, const GoalStages& stages) {
  const Option& rounds = stages.fit.option("fit-rounds");
  const OtherValue few(rounds,
                       number_text(std::min<double>(kRoundsBeforeDividing, *rounds.number())));
  session.run(stages.fit);
}

void scale_lines(const GoalStages& stages, double scale) {
  const Option& option = stages.trace.option("spacing-scale");
  option.parse_into(number_text(std::clamp(scale, option.min, option.max)));
}

double line_scale(const GoalStages& stages) {
  return stages.trace.option("spacing-scale").number().value_or(1);
}

void feed_back(Session& session, const GoalStages& stages, const LineAim& aim) {
  want_by_errors(session, stages);
  const double excess = kFeedbackExcess *
                        static_cast<double>(count_of(session, "quads", aim.counted)) /
                        static_cast<double>(aim.count);
  scale_lines(stages, line_scale(stages) * std::sqrt(excess));
}

double even_out(Session& session, const GoalStages& stages) {
  const auto& mesh = session.get<TriMesh>("mesh");
  const double cells = cells_at(mesh, used_distances(session.get<LineSet>("lines")));
  const double rms = want_by_errors(session, stages);
  const double more = cells_at(mesh, session.get<SizeField>("size")) / cells;
  scale_lines(stages, std::sqrt(kEvenExcess * more));
  trace_and_mesh(session, stages);
  return rms / std::sqrt(surface_area(mesh) / cells);
}

void shrink_to_tolerance(Session& session, const GoalStages& stages, const std::string& tolerance) {
  trace_and_mesh(session, stages);
  const Option& aim = stages.size.option("size-tolerance");
  Length length = Length::parse(tolerance);
  length.value *= kAimedAt;
  {
    const OtherValue aimed_at(aim, aim.value().empty() ? length.to_string() : aim.value());
    want_by_errors(session, stages);
  }
  stages.trace.option("spacing-scale").parse_into(kScaleOfLines);
}

void want_closer_only_there(Session& session, const GoalStages& stages,
                            const std::vector<Vec3>& places, double factor) {
  const Option& option = stages.trace.option("spacing-scale");
  if (session.has("size")) {
    SizeField wanted = session.get<SizeField>("size");
    const double scale = line_scale(stages);
    for (auto* distances : {&wanted.along, &wanted.across}) {
      for (double& d : *distances) d *= scale;
    }
    want_closer(session, wanted, places, factor);
  } else {
    want_closer(session, used_distances(session.get<LineSet>("lines")), places, factor);
  }
  option.parse_into(kScaleOfLines);
}

void want_relatively_closer(Session& session, const std::vector<Vec3>& places, double factor) {
  const SizeField used = used_distances(session.get<LineSet>("lines"));
  want_closer(session,
              session.has("size") ? scaled_like(session.get<SizeField>("size"), used) : used,
              places, factor);
}

void want_closer_for_as_many(Session& session, const GoalStages& stages,
                             const std::vector<Vec3>& places, double factor) {
  const auto& mesh = session.get<TriMesh>("mesh");
  const double cells = cells_at(mesh, used_distances(session.get<LineSet>("lines")));
  want_relatively_closer(session, places, factor);
  const double more = cells_at(mesh, session.get<SizeField>("size")) / cells;
  scale_lines(stages, std::sqrt(kEvenExcess * more));
}

void fit_refined(Session& session, const GoalStages& stages) {
  session.provide_as("quads", session.get<QuadMesh>("refined"), "refined");
  session.run(stages.fit);
}

}  // namespace strake
