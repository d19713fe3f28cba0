#include "stages/refine/thinning.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "stages/refine/thin_out.h"

namespace strake {
namespace {

/// Distances, in tolerances.
constexpr std::array<double, Thinning::kLevels> kDistances = {0.8, 0.5, 0.25, 0.05};
/// Faces of an inlay that are not worth it, for faces that cross: for each cell that goes, or as a
/// share of all cells, whatever is more.
constexpr std::size_t kMostFacesPerCell = 4;
constexpr double kMostFacesShare = 0.02;
/// Share of vertices that inlays for faces that cross may add without being thinned out more. What
/// a count allows is a little more.
constexpr double kMostAdded = 0.03;
/// Times that inlays are thinned out by the next distance, not by none, where they have faults.
constexpr int kMostThinnings = 12;
/// Times that inlays are thinned out less in vain: no fewer faces cross others.
constexpr int kThinningsInVain = 3;
/// Largest growth of the ball around a fault in which inlays are thinned out less.
constexpr double kLargestScale = 1024;
constexpr Index kAnyNumber = std::numeric_limits<Index>::max();
const Ball kEverywhere = {Vec3::Zero(), std::numeric_limits<double>::infinity()};

/// Whether an inlay has many faces for what it takes the place of.
bool is_large(const Inlay& inlay, Index cells) {
  const auto few = static_cast<std::size_t>(kMostFacesShare * cells);
  return inlay.faces.size() > std::max(few, kMostFacesPerCell * inlay.cells.size());
}

/// Thins inlays out less around faces beyond the tolerance, in as large balls as it takes, and
/// around faces that cross others, which they may have done before.
/// \param beyond, crossing  [inlays]
/// \param levels            changes to smaller distances
/// \return the inlays for which that changes anything
std::vector<std::size_t> lessen(std::vector<Thinning>& thinnings,
                                const std::vector<std::vector<Ball>>& beyond,
                                const std::vector<std::vector<Ball>>& crossing,
                                std::size_t levels) {
  std::vector<std::size_t> changed;
  for (std::size_t s = 0; s < thinnings.size(); ++s) {
    bool is_less = thinnings[s].lessen(crossing[s], 1, levels);
    for (double scale = 1; !is_less && scale <= kLargestScale; scale *= 2) {
      is_less = thinnings[s].lessen(beyond[s], scale, levels);
    }
    if (is_less) changed.push_back(s);
  }
  return changed;
}

/// Around a face, through its farthest corner. \param origin  of the input
Ball ball_around(const PolyMesh& mesh, Index face, const Vec3& origin) {
  Ball ball{Vec3::Zero(), 0};
  for (const Index v : mesh.face(face)) ball.middle += mesh.positions[v];
  ball.middle /= static_cast<double>(mesh.face(face).size());
  for (const Index v : mesh.face(face)) {
    ball.radius = std::max(ball.radius, (mesh.positions[v] - ball.middle).norm());
  }
  ball.middle -= origin;
  return ball;
}

/// [inlays] around faces of them, and beside these.
std::vector<std::vector<Ball>> balls_around(const InlayHost& host, const std::vector<Inlay>& inlays,
                                            const Inlaid& inlaid, const std::vector<Index>& faces) {
  std::vector<std::vector<Ball>> result(inlays.size());
  for (const Index f : faces) {
    const Ball ball = ball_around(inlaid.quads.mesh, f, host.surfaces().mesh().origin);
    for (const std::size_t s : host.inlays_at(inlays, inlaid, f)) result[s].push_back(ball);
  }
  return result;
}

/// As `thin`, until there are more vertices than `most` without large inlays: thinned out less
/// there are only more.
void thin_while_few(const InlayHost& host, double distance, Index most,
                    std::vector<Inlay>& inlays) {
  const Index cells = host.quads().mesh.face_count();
  const SurfaceLines lines(host.surfaces().mesh());
  std::vector<Thinning> thinnings;
  for (const Inlay& inlay : inlays) thinnings.emplace_back(host.surfaces(), lines, inlay);
  std::vector<std::size_t> changed(inlays.size());
  std::iota(changed.begin(), changed.end(), 0);
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  std::vector<Inlay> best = inlays;
  int in_vain = 0;
  for (int time = 0; !changed.empty() && in_vain < kThinningsInVain; ++time) {
    tbb::parallel_for(std::size_t{0}, changed.size(), [&](std::size_t i) {
      inlays[changed[i]].faces = thinnings[changed[i]].faces(distance);
    });
    const Inlaid now = host.with(inlays);
    const Faults bad = host.beyond(now);
    std::vector<Index> crossing = host.crossing(now);
    std::erase_if(crossing, [&](Index f) { return now.inlay[f] == kNone; });
    if (!bad.any() && crossing.size() < fewest) {
      fewest = crossing.size();
      best = inlays;
      in_vain = 0;
    } else if (!bad.any()) {
      ++in_vain;
    }
    if (now.quads.mesh.vertex_count() > most &&
        std::ranges::none_of(inlays, [&](const Inlay& inlay) { return is_large(inlay, cells); })) {
      break;
    }
    const std::size_t levels = time < kMostThinnings ? 1 : Thinning::kLevels;
    changed = lessen(thinnings, balls_around(host, inlays, now, bad.faces),
                     balls_around(host, inlays, now, crossing), levels);
    if (!changed.empty() || !bad.any()) continue;
    for (std::size_t s = 0; s < inlays.size(); ++s) {  // it is not known where
      if (thinnings[s].lessen({kEverywhere}, 1, levels)) changed.push_back(s);
    }
  }
  inlays = std::move(best);
}

}  // namespace

Thinning::Thinning(const ComparedSurfaces& surfaces, const SurfaceLines& lines, const Inlay& inlay)
    : faces_(inlay.faces) {
  for (const Index v : inlay.outline) positions_.push_back(surfaces.positions()[v]);
  level_.assign(positions_.size(), kLevels);
  for (const SurfacePoint& point : inlay.points) {
    positions_.push_back(place_of(surfaces.mesh(), point));
    level_.push_back(lines.places(point).empty() ? 0 : kLevels);
  }
}

std::vector<std::array<Index, 3>> Thinning::faces(double tolerance) const {
  std::vector<double> distance;
  for (const std::size_t level : level_) {
    distance.push_back(level < kLevels ? kDistances[level] * tolerance : 0);
  }
  return thin_out(positions_, faces_, distance);
}

bool Thinning::lessen(const std::vector<Ball>& balls, double scale, std::size_t levels) {
  bool any = false;
  for (std::size_t v = 0; v < level_.size(); ++v) {
    const auto is_in = [&](const Ball& ball) {
      return (positions_[v] - ball.middle).norm() <= scale * ball.radius;
    };
    if (level_[v] == kLevels || !std::ranges::any_of(balls, is_in)) continue;
    level_[v] = std::min(level_[v] + levels, kLevels);
    any = true;
  }
  return any;
}

void thin(const InlayHost& host, double distance, std::vector<Inlay>& inlays) {
  thin_while_few(host, distance, kAnyNumber, inlays);
}

void thin_from(const InlayHost& host, double distance, std::vector<Inlay>& inlays) {
  const Index cells = host.quads().mesh.face_count();
  const std::vector<Inlay> whole = inlays;
  const auto most =
      static_cast<Index>((1 + kMostAdded) * static_cast<double>(host.quads().mesh.vertex_count()));
  using Price = std::pair<Index, std::size_t>;  // vertices too many, faces that cross
  Price least{kAnyNumber, 0};
  std::vector<Inlay> best;
  for (;;) {
    const bool is_last = distance >= host.tolerance();
    thin_while_few(host, distance, is_last ? kAnyNumber : most, inlays);
    std::erase_if(inlays, [&](const Inlay& inlay) { return is_large(inlay, cells); });
    const Inlaid thinned = host.with(inlays);
    const Price price{std::max(0, thinned.quads.mesh.vertex_count() - most),
                      host.crossing(thinned).size()};
    if (price < least) {
      least = price;
      best = inlays;
    }
    if (price == Price{} || is_last) break;
    distance = std::min(2 * distance, host.tolerance());
    inlays = whole;
  }
  inlays = std::move(best);
}

}  // namespace strake
