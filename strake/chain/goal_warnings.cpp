#include "strake/chain/goal_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <variant>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {
namespace {

/// Vertices of a result within a tolerance, over those of the input, of which the user is told.
constexpr Index kExcessive = 2;
/// Share of the length of feature lines from which on nobody needs to be told.
constexpr double kNearlyKept = 0.97;

/// Share of a tolerance that need not be told.
constexpr double kNegligible = 0.01;

/// A number of the report of a stage's last run; 0 where it has none.
double number_of(const Session& session, std::string_view stage, std::string_view name) {
  double found = 0;
  for (const StageRecord& record : session.records()) {
    if (record.provenance.stage == stage) found = record.report.number(name).value_or(found);
  }
  return found;
}

bool has_warned(const Session& session, std::string_view stage) {
  return std::ranges::any_of(session.records(), [&](const StageRecord& record) {
    return record.provenance.stage == stage && !record.report.warnings().empty();
  });
}

}  // namespace

void warn_of_count(Session& session, const LineAim& aim) {
  const std::int64_t reached = count_of(session, result_port(session), aim.counted);
  std::string why = "the shape, --max-spacing or the mesh's own resolution do not allow it";
  Index corners = corner_count(session);
  if (session.has("decimated")) corners = 0;  // decimation gives them up
  if (reached < aim.wanted && is_input_spent(session)) {
    why = fmt::format("decimation gives no more vertices than the {} of the input",
                      session.get<TriMesh>("mesh").vertex_count());
  } else if (reached > aim.wanted && session.has("decimated")) {
    why = has_warned(session, "decimate") ? "fewer would change the topology of the surface"
                                          : "faces of fewer cross, or miss the shape";
  } else if (session.has("decimated")) {
    why = "faces of more cross, or miss the shape";
  }
  const std::string missed =
      missed_count({aim.counted, aim.wanted, reached, corners}, "the nearest result has", why);
  if (!missed.empty()) session.say("warning: " + missed);
}

void warn_of_excess(Session& session) {
  const std::int64_t given = given_vertex_count(session);
  const Index made = session.get<QuadMesh>("refined").mesh.vertex_count();
  if (made <= kExcessive * given) return;
  session.say(fmt::format(
      "warning: the result has {} vertices, the input {}: its own faces are larger than "
      "cells may be; a larger --tolerance takes fewer, on flats a larger --max-spacing",
      made, given));
}

void say_what_is_proven(Session& session, double tolerance) {
  const double smoothed = number_of(session, "import", "noise.moved_largest_share");
  const double moved = number_of(session, "import", "repairs.farthest_moved") + smoothed;
  double removed = 0;
  for (const char* kind : {"unusable_faces", "inner_faces", "folded_slivers"}) {
    removed += number_of(session, "import", std::string("repairs.") + kind);
  }
  std::string what;
  if (moved * session.get<TriMesh>("mesh").diagonal > kNegligible * tolerance) {
    what = fmt::format("moved vertices by up to {:.2g} % of the diagonal", 100 * moved);
  }
  if (removed > 0) {
    what += fmt::format("{}removed {:.0f} face{}", what.empty() ? "" : " and ", removed,
                        removed == 1 ? "" : "s");
  }
  if (what.empty()) return;
  session.say(fmt::format(
      "warning: the tolerance is proven for the mesh after repairs{}, and these {}: the "
      "result may be farther from the file by that",
      smoothed > 0 ? " and --denoise" : "", what));
}

void warn_of_distance(Session& session, const Report& measures, double tolerance) {
  const double largest = measures.number("distance.max").value_or(0);
  if (largest <= tolerance) return;
  session.say(fmt::format(
      "warning: the result is {:.3g} off the surface, more than the tolerance of {:.3g}", largest,
      tolerance));
}

void warn_of_listed_edges(Session& session, const Report& measures) {
  const double kept = measures.number("features.kept_share").value_or(1);
  if (!session.has("feature-edges") || kept >= kNearlyKept) return;
  session.say(fmt::format(
      "warning: {:.0f} % of the length of feature lines have edges along them: short ones are left "
      "out where cells are large; ask for more of them",
      100 * kept));
}

}  // namespace strake
