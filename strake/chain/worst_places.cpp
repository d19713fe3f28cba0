#include "strake/chain/worst_places.h"

#include <algorithm>
#include <string>

#include "common/core/error.h"
#include "common/core/number_text.h"
#include "common/core/wanted_count.h"
#include "strake/chain/counted.h"
#include "strake/chain/line_search.h"

namespace strake {
namespace {

/// Faces of a result and of its input, up to which it is looked at: else it takes too long.
constexpr std::int64_t kMostFaces = 10000;
constexpr std::int64_t kMostInputFaces = 500000;
/// Share of the accuracy of a count that may be used up.
constexpr double kOfCountTolerance = 0.8;

}  // namespace

void improve_worst_places(Session& session, const GoalStages& stages,
                          const std::optional<LineAim>& aim) {
  const char* port = result_port(session);
  if (!goes_by_errors(session, stages) ||
      session.get<TriMesh>("mesh").face_count() > kMostInputFaces ||
      count_of(session, port, Counted::faces) > kMostFaces) {
    return;
  }
  const Option& share = stages.worst.option("worst-share");
  double room = share.number().value();
  if (aim) {
    const auto given = static_cast<double>(count_of(session, port, aim->counted));
    const double most =
        (1 + kOfCountTolerance * kCountTolerance) * static_cast<double>(aim->wanted);
    room = std::min(room, most / given - 1);
  }
  if (room <= 0) return;
  const OtherValue as_room_allows(share, number_text(room));
  Session tried = session;
  tried.use_as("fitted", port);
  try {
    const Report& report = tried.run(stages.worst);
    if (report.number("refine.largest") == report.number("refine.largest_before")) return;
  } catch (const AlgorithmError& error) {
    session.say(std::string("warning: left the worst places as they were: ") + error.what());
    return;
  }
  session = std::move(tried);
  session.keep(stages.worst);
}

}  // namespace strake
