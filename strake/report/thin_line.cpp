#include "strake/report/thin_line.h"

#include <span>

#include "common/geometry/chain_corners.h"

namespace strake::report {

std::vector<std::size_t> thin_line(const std::vector<Vec3>& points,
                                   std::vector<std::uint8_t> is_fixed, double tolerance) {
  is_fixed.front() = is_fixed.back() = 1;
  std::vector<std::size_t> kept = {0};
  for (std::size_t i = 1; i < points.size(); ++i) {
    if (is_fixed[i] == 0) continue;
    const std::size_t from = kept.back();
    const std::span<const Vec3> run(&points[from], i + 1 - from);
    for (const std::size_t corner : corners_of_chain(run, tolerance)) kept.push_back(from + corner);
    kept.push_back(i);
  }
  return kept;
}

}  // namespace strake::report
