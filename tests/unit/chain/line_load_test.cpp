#include <gtest/gtest.h>

#include <array>

#include "common/core/line_set.h"
#include "common/core/poly_mesh.h"
#include "strake/chain/line_steps.h"
#include "tests/support/mesh_support.h"

namespace strake {
namespace {

class LoadOfLines : public ::testing::Test {
 protected:
  LoadOfLines() {
    PolyMesh triangle;
    triangle.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)};
    triangle.add_face(std::array<Index, 3>{0, 1, 2});
    mesh_ = support::plain_tri_mesh(triangle);
  }

  /// A line across the only face, from one of its half-edges to the next.
  void add_chord(LineFamily family, Index halfedge, double share) {
    lines_.points.push_back({halfedge, share});
    lines_.points.push_back({TriMesh::next(halfedge), 1 - share});
    lines_.chord_face.insert(lines_.chord_face.end(), {0, kNone});
    lines_.chord_family.insert(lines_.chord_family.end(), {family, family});
    lines_.offsets.push_back(static_cast<Index>(lines_.points.size()));
  }

  TriMesh mesh_;
  LineSet lines_;
};

TEST_F(LoadOfLines, IsEndsOnTheBoundaryAndPairsOfBothFamilies) {
  for (int i = 1; i <= 3; ++i) add_chord(LineFamily::minimum, 0, i / 8.0);
  for (int i = 1; i <= 5; ++i) add_chord(LineFamily::maximum, 1, i / 8.0);
  EXPECT_EQ(load_of(mesh_, lines_).nodes, 2 * (3 + 5) + 3 * 5);
  EXPECT_EQ(load_of(mesh_, lines_).fullest_face, 5);
}

TEST_F(LoadOfLines, FeatureAndBoundaryLinesAreNone) {
  add_chord(LineFamily::boundary, 0, 0.5);
  add_chord(LineFamily::feature, 1, 0.5);
  EXPECT_EQ(load_of(mesh_, lines_).nodes, 0);
  EXPECT_EQ(load_of(mesh_, lines_).fullest_face, 0);
}

// As around a spike, where lines go through its few faces again and again, and end nowhere.
TEST_F(LoadOfLines, IsChordsOfOneFamilyThatCrossNothingToo) {
  for (int i = 0; i < 100; ++i) {
    lines_.points.push_back({0, 0.5});
    lines_.chord_face.push_back(0);
    lines_.chord_family.push_back(LineFamily::maximum);
  }
  lines_.offsets.push_back(100);
  mesh_.twin[0] = 0;  // no boundary
  EXPECT_EQ(load_of(mesh_, lines_).nodes, 0);
  EXPECT_EQ(load_of(mesh_, lines_).fullest_face, 100);
}

}  // namespace
}  // namespace strake
