#include "strake/chain/facet_height.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "common/core/poly_mesh.h"

namespace strake {
namespace {

PolyMesh square() {
  PolyMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  mesh.add_face(std::array<Index, 4>{0, 1, 2, 3});
  return mesh;
}

TEST(FacetHeight, FallsWithTheVerticesThereAreToSpare) {
  const PolyMesh mesh = square();
  const double diagonal = std::sqrt(2);
  EXPECT_FALSE(facet_height(mesh, diagonal, 4.5));
  const double cell = std::sqrt(1 / 6.0) / diagonal;
  EXPECT_NEAR(facet_height(mesh, diagonal, 6)->value, 0.03 * cell, 1e-9);
  EXPECT_LT(facet_height(mesh, diagonal, 9)->value, 0.005 * cell);
}

TEST(FacetHeight, CopiesOfVerticesAndWhatIsNoneDoNotCount) {
  PolyMesh mesh = square();
  for (int i = 0; i < 4; ++i) mesh.positions.push_back(mesh.positions[i]);
  mesh.positions.emplace_back(std::numeric_limits<double>::quiet_NaN(), 0, 0);
  mesh.add_face(std::array<Index, 3>{0, 1, 8});
  mesh.add_face(std::array<Index, 3>{0, 1, 99});
  EXPECT_EQ(facet_height(mesh, 1, 6), facet_height(square(), 1, 6));
}

TEST(FacetHeight, OfNothingIsNone) { EXPECT_FALSE(facet_height({}, 0, 100)); }

}  // namespace
}  // namespace strake
