#include "common/geometry/chain_corners.h"

#include <gtest/gtest.h>

#include <vector>

namespace strake {
namespace {

TEST(ChainCorners, AreWhereAChainLeavesStraightPieces) {
  // A tooth of height 1, and one of 0.1.
  const std::vector<Vec3> chain = {{0, 0, 0}, {1, 0, 0},   {1.5, 1, 0}, {2, 0, 0},
                                   {3, 0, 0}, {4, 0.1, 0}, {5, 0, 0}};
  EXPECT_EQ(corners_of_chain(chain, 0.2), (std::vector<std::size_t>{1, 2, 3}));
  EXPECT_EQ(corners_of_chain(chain, 0.04), (std::vector<std::size_t>{1, 2, 3, 4, 5}));
  EXPECT_TRUE(corners_of_chain(chain, 1).empty());
  EXPECT_TRUE(corners_of_chain(std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}}, 0).empty());
}

}  // namespace
}  // namespace strake
