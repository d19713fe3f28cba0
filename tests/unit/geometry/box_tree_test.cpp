#include "common/geometry/face_crossings/box_tree.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace strake {
namespace {

std::vector<BoxTree::Box> random_boxes(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1);
  std::uniform_real_distribution<double> size(0, 0.1);
  const auto point = [&](auto& number) {
    return Vec3(number(random), number(random), number(random));
  };
  std::vector<BoxTree::Box> boxes;
  for (int i = 0; i < count; ++i) {
    const Vec3 corner = point(place);
    boxes.emplace_back(corner, corner + point(size));
  }
  return boxes;
}

TEST(BoxTree, FindsWhatLookingAtAllBoxesFinds) {
  for (const int count : {0, 1, 3, 4, 5, 6, 7, 8, 9, 17, 100, 5001}) {
    const std::vector<BoxTree::Box> boxes = random_boxes(count);
    const BoxTree tree(boxes);
    for (const BoxTree::Box& wanted : random_boxes(std::min(count, 40))) {
      std::vector<Index> found;
      tree.visit_touching(wanted, [&](Index i) { found.push_back(i); });
      std::vector<Index> touching;
      for (Index i = 0; i < count; ++i) {
        if (boxes[i].intersects(wanted)) touching.push_back(i);
      }
      std::sort(found.begin(), found.end());
      EXPECT_EQ(found, touching) << count;
    }
  }
}

TEST(BoxTree, FindsPairsOnceThatLookingAtAllOfThemFinds) {
  for (const int count : {0, 1, 2, 4, 5, 6, 7, 9, 17, 100, 1001}) {
    const std::vector<BoxTree::Box> boxes = random_boxes(count);
    std::vector<std::array<Index, 2>> found;
    const BoxTree tree(boxes);
    for (Index part = 0; part < tree.part_count(); ++part) {
      tree.visit_touching_pairs(part, [&](Index i, Index j) {
        found.push_back({std::min(i, j), std::max(i, j)});
      });
    }
    std::vector<std::array<Index, 2>> touching;
    for (Index i = 0; i < count; ++i) {
      for (Index j = i + 1; j < count; ++j) {
        if (boxes[i].intersects(boxes[j])) touching.push_back({i, j});
      }
    }
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, touching) << count;
  }
}

}  // namespace
}  // namespace strake
