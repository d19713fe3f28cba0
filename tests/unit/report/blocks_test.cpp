#include "strake/report/blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <set>

#include "tests/unit/report/decoded.h"

namespace strake::report_test {
namespace {

using report::Blocks;
using Triangle = std::array<std::uint32_t, 3>;

/// A triangle begun at its least corner: the codec may turn them.
Triangle from_least(Triangle corners) {
  std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end()), corners.end());
  return corners;
}

TEST(Blocks, RowsAndTrianglesComeBackInOrder) {
  std::mt19937 random(1);
  std::vector<std::array<std::uint16_t, 4>> rows(1000);
  for (auto& row : rows) {
    for (auto& x : row) x = static_cast<std::uint16_t>(random());
  }
  std::vector<std::uint32_t> corners;
  for (std::uint32_t t = 0; t < 999; ++t) {
    const auto below = [&](std::uint32_t end) {
      return static_cast<std::uint32_t>(random() % end);
    };
    const std::uint32_t a = below(990);
    corners.insert(corners.end(), {a, a + 1 + below(4), a + 5 + below(4)});
  }
  Blocks blocks;
  const nlohmann::ordered_json first = blocks.vertices(rows);
  const nlohmann::ordered_json second = blocks.triangles(corners);
  const nlohmann::ordered_json third = blocks.vertices(std::vector<std::uint32_t>{});
  const auto bytes = unpacked(blocks);
  EXPECT_EQ(bytes.size(), blocks.size());

  EXPECT_EQ((decode<std::array<std::uint16_t, 4>>(first, bytes)), rows);
  const auto decoded = decode<std::uint32_t>(second, bytes);
  ASSERT_EQ(decoded.size(), corners.size());
  for (std::size_t c = 0; c < corners.size(); c += 3) {
    EXPECT_EQ(from_least({decoded[c], decoded[c + 1], decoded[c + 2]}),
              from_least({corners[c], corners[c + 1], corners[c + 2]}));
  }
  EXPECT_TRUE(decode<std::uint32_t>(third, bytes).empty());
}

TEST(Blocks, AreUnpackedWhateverTheirLength) {
  std::mt19937 random(2);
  std::set<std::ptrdiff_t> paddings;  // of base64
  for (std::size_t count = 0; count < 12; ++count) {
    std::vector<std::uint32_t> rows(count);
    for (std::uint32_t& row : rows) row = static_cast<std::uint32_t>(random());
    Blocks blocks;
    const nlohmann::ordered_json block = blocks.vertices(rows);
    EXPECT_EQ(decode<std::uint32_t>(block, unpacked(blocks)), rows);
    const std::string packed = blocks.packed();
    paddings.insert(std::count(packed.begin(), packed.end(), '='));
  }
  EXPECT_EQ(paddings, (std::set<std::ptrdiff_t>{0, 1, 2}));
}

}  // namespace
}  // namespace strake::report_test
