#include "common/core/wanted_count.h"

#include <cmath>

namespace strake {

const char* name_of(Counted counted) { return counted == Counted::vertices ? "vertices" : "faces"; }

double count_miss(std::int64_t wanted, std::int64_t reached) {
  return std::abs(static_cast<double>(reached - wanted)) / static_cast<double>(wanted);
}

std::string missed_count(const ReachedCount& count, const std::string& what,
                         const std::string& why) {
  if (count_miss(count.wanted, count.reached) <= kCountTolerance) return "";
  const bool is_by_corners = count.counted == Counted::vertices && count.corners > count.wanted &&
                             count.reached > count.wanted;
  return std::to_string(count.wanted) + " " + name_of(count.counted) + " were wanted, but " + what +
         " " + std::to_string(count.reached) + ": " +
         (is_by_corners ? "feature and boundary lines have " + std::to_string(count.corners) +
                              " corners; a larger --feature-angle makes fewer features"
                        : why);
}

}  // namespace strake
