#include "common/stage/pace.h"

#include <fmt/format.h>

#include <cmath>

namespace strake {

std::string pace_text(double seconds, double fraction) {
  constexpr double kTooEarly = 1;
  constexpr double kTooLittle = 0.01;
  if (seconds < kTooEarly || fraction < kTooLittle || fraction >= 1) return "";
  const double rate = fraction / seconds;
  const auto left = static_cast<long>(std::ceil((1 - fraction) / rate));
  const std::string time = left < 100    ? fmt::format("{} s", left)
                           : left < 6000 ? fmt::format("{} min", (left + 59) / 60)
                                         : fmt::format("{:.1f} h", double(left) / 3600);
  return fmt::format("{:.2g} %/s, {} left", 100 * rate, time);
}

}  // namespace strake
