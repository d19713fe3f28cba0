#include "strake/chain/too_coarse.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "common/core/error.h"
#include "strake/chain/replace_crossing.h"
#include "strake/chain/result_faults.h"

namespace strake {
namespace {

/// Root mean square of the distance, in mean lengths of cells, from which on a result is compared,
/// and from which on it is seen.
constexpr double kSuspect = 0.04;
constexpr double kSeen = 0.06;
/// Largest distance, in the same, from which on a part of the shape is lost, and count up to which
/// that is looked at: among more cells one such place is a detail, and all lines are worth more.
constexpr double kShapeLost = 0.8;
constexpr std::int64_t kMostForPart = 20000;
/// Share of the faces that cross, from which on cells are no longer in order, and from which on
/// distances from them say nothing; that of another result which is much less, as a share of it;
/// and most there may be in one that shows a shape which lines miss.
constexpr double kManyCross = 0.02;
constexpr double kTangled = 0.3;
constexpr double kFewer = 0.25;
constexpr double kMayCrossForShape = 0.1;
/// Share of the faces that may be odd in a result where none cross, as some do in another one: more
/// than there, and in all. Even few that cross are of no use to many programs.
constexpr double kMoreOdd = 0.1;
constexpr double kFewOdd = 0.15;
/// The same where a part of the shape is lost otherwise: one place is not worth all quads.
constexpr double kMoreOddForPart = 0.25;
/// Share of a wanted count that a result may be off by.
constexpr double kFarOff = 0.05;
/// Share of a distance that is much less than it: of one that is seen, or of a result that has no
/// more quads than the other, and of another one.
constexpr double kMuchLess = 0.5;
constexpr double kVeryMuchLess = 0.25;
/// Distance that is hardly more, where another fault is much less; that which may be where a count
/// is missed by more than `kMissed`.
constexpr double kHardlyMore = 1.1;
constexpr double kMissed = 0.25;
constexpr double kMore = 1.5;
/// Share of faces that are no quads, as lines leave it: of more one is told.
constexpr double kUsuallyOdd = 0.05;
/// Times that the count is corrected where faces are counted, and error that is small enough.
constexpr int kMostCorrections = 3;
constexpr double kCountAccuracy = 0.02;
/// Counts nearby that are tried at most where faces cross, and vertices or faces in all of them;
/// their distance from each other as a share of the count; share of the faces from which on others
/// cross, too.
constexpr std::int64_t kOtherCounts = 8;
constexpr std::int64_t kMostInOthers = 16000;
constexpr double kNextCount = 0.004;
constexpr double kManyCrossDecimated = 0.1;
/// Share of the faces that cross within a tolerance, from which on it is below the noise.
constexpr double kManyCrossWithin = 0.005;
/// Samples of the first look: what has less than this share of a suspect distance with those is not
/// suspect.
constexpr double kFirstSamples = 40000;
constexpr double kFarFromSuspect = 0.5;

struct Goal {
  Counted counted;
  std::int64_t wanted;
};

/// The count of the quads at a port, as a share of what is wanted.
double reached(const Session& session, const char* port, const Goal& goal) {
  return static_cast<double>(count_of(session, port, goal.counted)) /
         static_cast<double>(goal.wanted);
}

bool shows_the_shape(const ResultFaults& faults, std::int64_t wanted) {
  const bool is_part_lost = faults.largest > kShapeLost && wanted <= kMostForPart;
  return faults.distance <= kSuspect && !is_part_lost && faults.crossing == 0;
}

bool is_too_coarse(const ResultFaults& faults, std::int64_t wanted) {
  return !shows_the_shape(faults, wanted) || faults.missing > kFarOff;
}

/// Whether lines are so much farther off than another result that they miss the shape.
bool is_shape_missed(const ResultFaults& other, const ResultFaults& lines) {
  return lines.distance > kSeen && other.distance < kVeryMuchLess * lines.distance;
}

/// Whether one of the faults is much less, and none is more. Where lines are very much farther off
/// they miss the shape, and where most of their faces cross they are none: other faults count less
/// then.
bool is_much_better(const ResultFaults& other, const ResultFaults& faults) {
  const bool crosses_less =
      faults.crossing > kManyCross && other.crossing < kFewer * faults.crossing;
  if (faults.crossing > kTangled) return crosses_less;
  const bool is_enough = faults.distance > kSeen || other.odd <= faults.odd;
  const double share = is_enough ? kMuchLess : kVeryMuchLess;
  const bool is_nearer = other.distance < share * faults.distance;
  const bool is_found = faults.largest > kShapeLost && other.largest < kMuchLess * faults.largest &&
                        other.odd <= faults.odd + kMoreOddForPart;
  const bool is_clean = faults.crossing > 0 && other.crossing == 0 &&
                        other.odd <= std::max(faults.odd + kMoreOdd, kFewOdd);
  const bool is_as_wanted = faults.missing > kFarOff && other.missing < kFarOff / 2;
  const bool is_sound =
      is_shape_missed(other, faults)
          ? other.crossing <= std::max(faults.crossing, kMayCrossForShape)
          : other.crossing <= faults.crossing && other.missing <= std::max(faults.missing, kFarOff);
  const double farther = is_as_wanted && faults.missing > kMissed ? kMore : kHardlyMore;
  return (is_nearer || is_clean || is_found || crosses_less || is_as_wanted) &&
         other.distance <= farther * faults.distance && is_sound;
}

/// Decimates until the count is met, as nearly as a few corrections allow.
void decimate_to_count(Session& session, const GoalStages& stages, const Goal& goal) {
  // Cells of lines have about as many vertices a face.
  double vertices = static_cast<double>(count_of(session, "fitted", Counted::vertices)) /
                    reached(session, "fitted", goal);
  const Option& option = stages.decimate.option("decimate-vertices");
  for (int i = 0; i < kMostCorrections; ++i) {
    const std::int64_t asked = std::max(std::llround(vertices), std::llround(option.min));
    option.parse_into(std::to_string(asked));
    session.run(stages.decimate);
    // Where the topology allows no fewer, to ask for fewer gives the same.
    if (session.get<QuadMesh>("decimated").mesh.vertex_count() > asked) return;
    const double share = reached(session, "decimated", goal);
    if (std::abs(share - 1) <= kCountAccuracy) return;
    vertices /= share;
  }
}

/// Decimated to the count, and fitted. \throw AlgorithmError where that cannot be done
Session decimated(Session session, const GoalStages& stages, const Goal& goal) {
  session.withdraw("uncrossed");
  decimate_to_count(session, stages, goal);
  session.provide_as("quads", session.get<QuadMesh>("decimated"), "decimated");
  session.run(stages.fit);
  return session;
}

}  // namespace

bool needs_lines(const Session& session, const GoalStages& stages, bool lines_only) {
  return lines_only || only_quads(stages) || session.has("density") || session.has("guides");
}

const DecimatedRival::Made* DecimatedRival::made(const Session& session, CrossingPlaces& crossing) {
  if (!made_ && why_not_.empty()) {
    try {
      Session other = decimated(session, stages_, {counted_, wanted_});
      const ResultFaults faults = faults_of(other, counted_, wanted_, crossing);
      for (const char* port : {"lines", "refined", "size"}) other.withdraw(port);
      made_ = {std::move(other), faults};
    } catch (const AlgorithmError& error) {
      why_not_ = error.what();
    }
  }
  return made_ ? &*made_ : nullptr;
}

bool DecimatedRival::is_better(const Session& session, CrossingPlaces& crossing) {
  const Made* other = made(session, crossing);
  return other != nullptr &&
         is_much_better(other->faults, faults_of(session, counted_, wanted_, crossing));
}

bool DecimatedRival::shows_what_lines_miss(const Session& session, CrossingPlaces& crossing) {
  const ResultFaults faults = faults_of(session, counted_, wanted_, crossing);
  if (faults.distance <= kSeen) return false;
  const Made* other = made(session, crossing);
  return other != nullptr && is_shape_missed(other->faults, faults) &&
         is_much_better(other->faults, faults);
}

bool DecimatedRival::replace_if_too_coarse(Session& session, CrossingPlaces& crossing) {
  const ResultFaults first = faults_of(session, counted_, wanted_, crossing, kFirstSamples);
  if (first.distance < kFarFromSuspect * kSuspect && !is_too_coarse(first, wanted_)) return false;
  const ResultFaults faults = faults_of(session, counted_, wanted_, crossing);
  if (!is_too_coarse(faults, wanted_)) return false;
  session.say(fmt::format("lines are coarse for this shape at {} {}; decimating to compare",
                          wanted_, name_of(counted_)));
  const Made* other = made(session, crossing);
  if (other == nullptr) {
    session.say("warning: kept the lines: " + why_not_);
    return false;
  }
  if (!is_much_better(other->faults, faults)) return false;
  session.withdraw("uncrossed");
  session.take_from(other->session, {"quads"});
  for (const Stage* stage : {&stages_.decimate, &stages_.fit}) {
    session.take_run(*stage, other->session);
    session.keep(*stage);
  }
  const bool is_spent = is_input_spent(session);
  std::string triangles;
  if (other->faults.odd > kUsuallyOdd) {
    triangles = is_spent ? ", and has more triangles" : ", and has more triangles: ask for more";
  }
  std::string why = "lines are too coarse for this shape";
  if (is_spent) why = "faces along lines cross or miss this shape";
  if (shows_the_shape(faults, wanted_)) why = "lines miss the count";
  session.say(fmt::format(
      "warning: {} at {} {}: the result was decimated instead{}; --lines-only keeps lines", why,
      wanted_, name_of(counted_), triangles));
  return true;
}

void part_decimated(Session& session, const GoalStages& stages, const LineAim& aim,
                    CrossingPlaces& crossing) {
  std::size_t fewest = replace_crossing(session, stages, aim, crossing).size();
  const Index faces = session.get<QuadMesh>("fitted").mesh.face_count();
  if (crossing.input_crosses() || static_cast<double>(fewest) > kManyCrossDecimated * faces) return;
  const std::int64_t step =
      std::llround(std::max(1.0, kNextCount * static_cast<double>(aim.wanted)));
  const Session first = session;
  const std::int64_t most = std::min(kOtherCounts, kMostInOthers / aim.wanted);
  for (std::int64_t i = 0; i < most && fewest > 0; ++i) {
    const std::int64_t off = (i / 2 + 1) * step;
    Session other = first;
    try {
      other = decimated(first, stages, {aim.counted, aim.wanted + (i % 2 == 0 ? off : -off)});
    } catch (const AlgorithmError&) {
      continue;
    }
    const std::size_t left = replace_crossing(other, stages, aim, crossing).size();
    if (left >= fewest) continue;
    fewest = left;
    session = other;
    session.keep(stages.decimate);
    session.keep(stages.fit);
  }
}

bool decimate_if_tangled(Session& session, const GoalStages& stages, CrossingPlaces& crossing,
                         std::size_t crossing_faces) {
  const PolyMesh& lines = session.get<QuadMesh>("refined").mesh;
  const auto before = static_cast<double>(crossing_faces);
  if (before <= kManyCrossWithin * lines.face_count()) return false;
  session.say(fmt::format("{} faces cross; decimating to compare", crossing_faces));
  Session other = session;
  try {
    const Index most = std::min(lines.vertex_count(), session.get<TriMesh>("mesh").vertex_count());
    stages.decimate.option("decimate-vertices").parse_into(std::to_string(most));
    other.run(stages.decimate);
    other.provide_as("quads", other.get<QuadMesh>("decimated"), "decimated");
    // Vertices that follow noise are best where they are.
    const OtherValue unmoved(stages.fit.option("fit-rounds"), "0");
    other.run(stages.fit);
    other.run(stages.refine);
  } catch (const Error& error) {
    session.say(std::string("warning: kept the lines: ") + error.what());
    return false;
  }
  const PolyMesh& decimated = other.get<QuadMesh>("refined").mesh;
  const auto left = static_cast<double>(crossing.of(decimated).size());
  if (left >= kFewer * before || decimated.vertex_count() > lines.vertex_count()) return false;
  session = other;
  for (const Stage* stage : {&stages.decimate, &stages.fit, &stages.refine}) session.keep(*stage);
  session.say(
      "warning: within this tolerance faces along lines cross, as where noise is higher: the "
      "result "
      "was decimated instead, and has more triangles; a larger --tolerance, or --denoise, makes "
      "quads, --lines-only keeps lines");
  return true;
}

}  // namespace strake
