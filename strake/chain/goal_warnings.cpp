#include "strake/chain/goal_warnings.h"

#include <fmt/format.h>

#include <string>

#include "common/core/poly_mesh.h"
#include "common/core/tri_mesh.h"

namespace strake {
namespace {

/// Vertices of a result within a tolerance, over those of the input, of which the user is told.
constexpr Index kExcessive = 2;

}  // namespace

void warn_of_count(Session& session, const LineAim& aim) {
  const std::int64_t reached = count_of(session, result_port(session), aim.counted);
  std::string why = "the shape, --max-spacing or the mesh's own resolution do not allow it";
  if (reached < aim.wanted && is_input_spent(session)) {
    why = fmt::format("decimation gives no more vertices than the {} of the input",
                      session.get<TriMesh>("mesh").vertex_count());
  }
  const std::string missed = missed_count({aim.counted, aim.wanted, reached, corner_count(session)},
                                          "the nearest result has", why);
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

}  // namespace strake
