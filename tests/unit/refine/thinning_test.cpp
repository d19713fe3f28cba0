#include "stages/refine/thinning.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "tests/support/result_cases.h"
#include "tests/unit/refine/inlay_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;

TEST(Thinning, LeavesMoreInBalls) {
  const Case c = grid(64, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  const std::set<Index> cells = nine_cells(cutter);
  const std::optional<Inlay> inlay = cutter.cut(cells);
  ASSERT_TRUE(inlay.has_value());
  Thinning thinning(surfaces, SurfaceLines(c.mesh), *inlay);
  const std::vector<Vec3> positions = positions_of(*inlay, surfaces);
  const Ball ball{surfaces.positions()[4 * 9 + 5], 0.08};  // a corner of the cell in the middle
  const auto shares_left = [&] {                           // of vertices in the ball, and elsewhere
    const auto inside = static_cast<Index>(inlay->outline.size());
    std::set<Index> left;
    for (const auto& t : thinning.faces(0.01)) left.insert(t.begin(), t.end());
    std::array<double, 2> count = {0, 0};
    std::array<double, 2> kept = {0, 0};
    for (Index v = inside; v < std::ssize(positions); ++v) {
      const std::size_t where = (positions[v] - ball.middle).norm() <= ball.radius ? 0 : 1;
      ++count[where];
      if (left.contains(v)) ++kept[where];
    }
    return std::array{kept[0] / count[0], kept[1] / count[1]};
  };
  std::array<double, 2> before = shares_left();
  EXPECT_LT(before[0], 0.3);
  EXPECT_LT(before[1], 0.3);
  for (std::size_t level = 0; level < Thinning::kLevels; ++level) {
    EXPECT_TRUE(thinning.lessen({ball}, 1, 1));
    const std::array<double, 2> after = shares_left();
    EXPECT_GE(after[0], before[0]);
    EXPECT_LT(after[1], 0.4);
    before = after;
  }
  EXPECT_EQ(before[0], 1);
  EXPECT_FALSE(thinning.lessen({ball}, 1, 1));
  EXPECT_TRUE(thinning.lessen({ball}, 100, Thinning::kLevels));
  EXPECT_EQ(thinning.faces(0.01), inlay->faces);
}

}  // namespace
}  // namespace strake
