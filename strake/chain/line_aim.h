#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "strake/chain/counted.h"

namespace strake {

/// How many vertices or faces lines are to give.
struct LineAim {
  Counted counted;
  std::int64_t count;
  std::int64_t wanted;  ///< by the user, of lines and of the cells that are divided
  double left;          ///< share of what is wanted that lines leave for dividing cells

  /// Share of the wanted count that another one is off by.
  [[nodiscard]] double miss(std::int64_t reached) const { return count_miss(wanted, reached); }
  /// How far its ratio to the wanted one is from one: half as many are as far off as twice as many.
  [[nodiscard]] double ratio_miss(std::int64_t reached) const {
    return std::abs(std::log(static_cast<double>(std::max<std::int64_t>(reached, 1)) /
                             static_cast<double>(wanted)));
  }
};

}  // namespace strake
