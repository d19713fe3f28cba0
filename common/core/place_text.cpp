#include "common/core/place_text.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>

namespace strake {
namespace {

/// Of the diagonal.
constexpr double kResolution = 1e-4;
constexpr double kFewestDigits = 4;
constexpr double kMostDigits = 15;

}  // namespace

std::string place_text(const Vec3& place, double diagonal) {
  const double digits = std::log10(place.cwiseAbs().maxCoeff() / (kResolution * diagonal));
  const double shown = std::isfinite(digits)
                           ? std::clamp(std::ceil(digits), kFewestDigits, kMostDigits)
                           : kFewestDigits;
  std::ostringstream text;
  text << std::setprecision(static_cast<int>(shown)) << '(' << place.x() << ", " << place.y()
       << ", " << place.z() << ')';
  return text.str();
}

}  // namespace strake
