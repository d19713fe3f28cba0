#include "stages/refine/thinning.h"

#include <algorithm>

#include "stages/refine/thin_out.h"

namespace strake {
namespace {

/// Distances, in tolerances.
constexpr std::array<double, Thinning::kLevels> kDistances = {0.8, 0.5, 0.25, 0.05};

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

}  // namespace strake
