#include "strake/chain/closer_lines.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "strake/chain/counted.h"
#include "strake/chain/line_steps.h"

namespace strake {
namespace {

/// Share of the faces that cross, from which on all lines are traced closer where nobody wants a
/// count; and times they are at most, also within a tolerance.
constexpr double kTooManyCross = 0.05;
constexpr int kMostTimesCloser = 4;
/// Root mean square of the distance of lines, in mean cell lengths, from which on they are traced
/// closer likewise: noise can hide the shape from them.
constexpr double kTooFarOff = 0.15;

/// Share of the faces that lines give that cross.
double crossing_share(const Session& session, CrossingPlaces& crossing) {
  return crossing_share(session, "quads", crossing.of(session.get<QuadMesh>("quads").mesh));
}

}  // namespace

bool may_be_too_coarse(const Session& session, const char* port) {
  return count_of(session, port, Counted::vertices) < given_vertex_count(session);
}

double crossing_share(const Session& session, const char* port, const std::vector<Vec3>& places) {
  return static_cast<double>(places.size()) / session.get<QuadMesh>(port).mesh.face_count();
}

void trace_apart(Session& session, const GoalStages& stages, CrossingPlaces& crossing,
                 double most) {
  trace_mesh_and_fit(session, stages);
  for (int i = 0; i < kMostTimesCloser && may_be_too_coarse(session, "quads"); ++i) {
    const double share = crossing_share(session, crossing);
    if (share <= most) return;
    most = kMended;
    session.say(fmt::format("{:.0f} % of the faces cross; tracing closer lines", 100 * share));
    scale_lines(stages, kCloser * line_scale(stages));
    trace_mesh_and_fit(session, stages);
  }
}

FreeTrace trace_freely(Session& session, const GoalStages& stages, std::int64_t feedback_rounds) {
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  trace_and_mesh(session, stages);
  double share = crossing_share(session, crossing);
  int times_left = kMostTimesCloser;
  const auto trace_closer = [&](const std::string& why) {
    session.say(why + "; tracing closer lines");
    scale_lines(stages, kCloser * line_scale(stages));
    trace_and_mesh(session, stages);
    share = crossing_share(session, crossing);
    --times_left;
  };
  while (times_left > 0 && share > kTooManyCross && may_be_too_coarse(session, "quads")) {
    trace_closer(fmt::format("{:.0f} % of the faces cross", 100 * share));
  }
  double scale = line_scale(stages);
  if (feedback_rounds == 0 || crossing.is_stacked()) return {scale, false};
  for (std::int64_t round = 0; round < feedback_rounds;) {
    const Session before = session;
    const double off = even_out(session, stages);
    if (round == 0 && off > kTooFarOff && times_left > 0 && may_be_too_coarse(before, "quads")) {
      session = before;
      scale_lines(stages, scale);
      trace_closer(fmt::format("cells are {:.2g} of their length off in the mean", off));
      scale = line_scale(stages);
      continue;
    }
    const double now = crossing_share(session, crossing);
    if (now > std::max(share, kTooManyCross)) {
      session = before;
      break;
    }
    share = now;
    ++round;
  }
  return {scale, true};
}

}  // namespace strake
