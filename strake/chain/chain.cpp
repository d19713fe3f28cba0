#include "strake/chain/chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/core/error.h"
#include "common/core/fields.h"
#include "common/core/poly_mesh.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "stages/coarsen/stage.h"
#include "stages/decimate/stage.h"
#include "stages/evaluate/stage.h"
#include "stages/fit/stage.h"
#include "stages/import/import.h"
#include "stages/import/stage.h"
#include "stages/lift/stage.h"
#include "stages/mesh/stage.h"
#include "stages/prolong/stage.h"
#include "stages/refine/stage.h"
#include "stages/refine/uncross/stage.h"
#include "stages/refine/worst/stage.h"
#include "stages/size/stage.h"
#include "stages/smooth/stage.h"
#include "stages/tensor/stage.h"
#include "stages/trace/stage.h"
#include "strake/chain/facet_height.h"
#include "strake/chain/facet_trial.h"
#include "strake/chain/goal_warnings.h"
#include "strake/chain/goals.h"

namespace strake {
namespace {

/// Heights of ridges that cells across them would cut off, in tolerances.
constexpr double kRidgeHeight = 2;

/// What one sees at once in a result should not be a surprise.
/// \throw PreconditionError where a density is one of another file's vertices
void require_density_of_input(const Session& session) {
  if (!session.has("density")) return;
  const std::size_t given = session.get<DensityField>("density").value.size();
  const std::size_t vertices = session.get<Polygons>("input").mesh.positions.size();
  if (given == vertices) return;
  throw PreconditionError(
      fmt::format("the density has {} vertices, and the mesh {}: give one of "
                  "the vertices of that file",
                  given, vertices));
}

void warn_of_crossing(Session& session, const std::string& port) {
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const std::size_t faces = crossing.of(session.get<QuadMesh>(port).mesh).size();
  if (faces == 0) return;
  session.say(fmt::format(
      "warning: {} face(s) of the result cross others where the input does not (those where it "
      "does are not counted): cells are larger than its details or than the space between its "
      "sheets; {}",
      faces,
      port == "refined" ? "a smaller --tolerance makes more of them" : "ask for more of them"));
}

}  // namespace

Chain::Chain()
    : GoalStages{.coarsen = coarsen_stage(),
                 .tensor = tensor_stage(),
                 .smooth = smooth_stage(),
                 .trace = trace_stage(),
                 .mesh = mesh_stage(),
                 .lift = lift_stage(),
                 .prolong = prolong_stage(),
                 .fit = fit_stage(),
                 .size = size_stage(),
                 .refine = refine_stage(),
                 .uncross = refine_uncross_stage(),
                 .worst = refine_worst_stage(),
                 .decimate = decimate_stage()},
      import(import_stage()),
      evaluate(evaluate_stage()) {}

OptionList Chain::declare(std::optional<std::int64_t>& rounds, bool& lines_only,
                          double& working_ratio) {
  return {{.name = "feedback-rounds",
           .target = &rounds,
           .unit = "",
           .help = "Times that lines are traced again by errors measured: to even them out where a "
                   "count is wanted, closer where they are too large for a tolerance. 1; with a "
                   "density and a count as many as it takes.",
           .min = 0,
           .max = 20},
          {.name = "lines-only",
           .target = &lines_only,
           .unit = "",
           .help = "Keep the result of lines also where they are too coarse for the shape at the "
                   "wanted count, or their faces cross within a tolerance, and decimating it does "
                   "much better."},
          {.name = "working-ratio",
           .target = &working_ratio,
           .unit = "",
           .help = "Vertices per wanted vertex of the coarser mesh on which lines are traced where "
                   "the input has more than twice as many; 0: always on the input.",
           .min = 0,
           .max = 1000}};
}

std::vector<const Stage*> Chain::stages() const {
  return {&import, &coarsen, &tensor, &smooth,  &trace, &mesh,     &lift,    &prolong,
          &fit,    &size,    &refine, &uncross, &worst, &decimate, &evaluate};
}

void Chain::check_goals() const {
  int goals = 0;
  for (const char* name : {"tolerance", "vertices", "faces"}) {
    if (!trace.option(name).value().empty()) ++goals;
  }
  if (goals > 1) {
    throw UsageError("--tolerance, --vertices and --faces exclude each other; give one of them");
  }
  const Chain untouched;
  const auto require_untouched = [](const Stage& stage, const Stage& other, const char* name) {
    if (stage.option(name).value() == other.option(name).value()) return;
    throw UsageError(fmt::format(
        "--{} follows from the goal here, and is for the program strake-{}; give --tolerance, "
        "--vertices or --faces",
        name, stage.name));
  };
  require_untouched(refine, untouched.refine, "refine-tolerance");
  require_untouched(refine, untouched.refine, "refine-vertices");
  const bool is_partly = refine.option("refine-partly").value() == "true";
  if (is_partly && trace.option("tolerance").value().empty()) {
    throw UsageError("--refine-partly hands on what misses a --tolerance; give one");
  }
  require_untouched(decimate, untouched.decimate, "decimate-vertices");
  require_untouched(coarsen, untouched.coarsen, "coarse-vertices");
}

std::string Chain::reach_goal(Session& session) const {
  // Counts are met by what faces are made of the lines, not by the lines themselves.
  const Option& scale = trace.option("spacing-scale");
  std::optional<OtherValue> once;
  if (const std::optional<WantedCount> wanted = wanted_count()) {
    if (scale.value().empty()) once.emplace(scale, "1");
    return meet_count(session, *this, wanted->counted, wanted->count, feedback_rounds, lines_only,
                      working_ratio);
  }
  const std::string tolerance = trace.option("tolerance").value();
  if (tolerance.empty()) return follow_spacing(session, *this, feedback_rounds);
  return meet_tolerance(session, *this, tolerance, feedback_rounds, lines_only);
}

void Chain::keep_ridges() const {
  const std::string tolerance = trace.option("tolerance").value();
  const Option& height = import.option("feature-height");
  const bool keeps_features = import.option("feature-angle").number() < 180;
  if (tolerance.empty() || !height.value().empty() || !keeps_features) return;
  Length ridge = Length::parse(tolerance);
  ridge.value *= kRidgeHeight;
  height.parse_into(ridge.to_string());
}

std::optional<Length> Chain::height_of_facets(const Session& session, double diagonal) const {
  const auto is_given = [&](const char* name) { return !import.option(name).value().empty(); };
  const std::optional<WantedCount> wanted = wanted_count();
  if (import.option("feature-angle").number() != ImportOptions{}.feature_angle_deg ||
      is_given("feature-height") || is_given("facet-height") || !wanted) {
    return std::nullopt;
  }
  // A quad-dominant mesh has about as many faces as vertices.
  return facet_height(session.get<Polygons>("input").mesh, diagonal,
                      static_cast<double>(wanted->count));
}

std::optional<Chain::WantedCount> Chain::wanted_count() const {
  for (const Counted counted : {Counted::vertices, Counted::faces}) {
    const std::optional<double> count = trace.option(name_of(counted)).number();
    if (count) return WantedCount{counted, std::llround(*count)};
  }
  return std::nullopt;
}

std::string Chain::run_with_facets(Session& session, const Length& height) const {
  const WantedCount wanted = wanted_count().value();
  const WayToResult way{stages(), [&](Session& other) { import_mesh(other); },
                        [&](Session& other) { return reach_goal(other); }};
  return make_with_facets_if_better(session, way, import.option("facet-height"), height,
                                    wanted.counted, wanted.count);
}

void Chain::import_mesh(Session& session) const {
  session.run(import);
  session.keep(import);
  session.withdraw("input");  // as large as all that is needed afterwards
}

std::string Chain::run(Session& session) const {
  check_goals();
  require_density_of_input(session);
  const double diagonal = diagonal_of(session.value("input"));
  for (const Stage* stage : stages()) check_lengths(stage->options, diagonal);
  keep_ridges();
  const Option& sides = refine.option("refine-sides");
  if (sides.value().empty()) sides.parse_into(mesh.option("max-sides").value());
  // Evenly is not how a density wants vertices in flats.
  if (session.has("density")) fit.option("keep-flats").parse_into("true");
  session.hold_warnings_of(mesh);
  session.hold_warnings_of(decimate);  // of counts, which are told of at the end
  std::string port;
  if (const std::optional<Length> facets = height_of_facets(session, diagonal)) {
    port = run_with_facets(session, *facets);
  } else {
    import_mesh(session);
    port = reach_goal(session);
  }
  if (!session.has("decimated")) session.say_held(mesh);  // else no lines are in the result
  warn_of_crossing(session, port);
  return port;
}

const Report& Chain::measure(Session& session, const std::string& port) const {
  const auto is_set = [](const Option& option) { return option.value() == "true"; };
  const std::string tolerance = trace.option("tolerance").value();
  const Option& most = evaluate.option("evaluate-tolerance");
  const bool is_proven = !tolerance.empty() && !is_set(mesh.option("pure-quads")) &&
                         !is_set(refine.option("refine-partly"));
  const bool is_check = is_proven && most.value().empty();
  if (is_check) most.parse_into(tolerance);
  const QuadMesh& quads = session.get<QuadMesh>(port);
  session.provide_as("candidate", Polygons{quads.mesh, quads.mesh_id, {}}, port);
  const Report* report = nullptr;
  try {
    report = &session.run(evaluate);
  } catch (const ToleranceError& error) {
    if (!is_check) throw;
    throw AlgorithmError("a result was taken to be within the tolerance that is not: " +
                         std::string(error.what()) + "; please report this model");
  }
  session.keep(evaluate);
  if (!tolerance.empty()) {
    const double wanted = Length::parse(tolerance).resolve(session.get<TriMesh>("mesh").diagonal);
    if (is_proven) {
      say_what_is_proven(session, wanted);
    } else {
      warn_of_distance(session, *report, wanted);
    }
  }
  warn_of_listed_edges(session, *report);
  return *report;
}

}  // namespace strake
