#include "stages/decimate/pair_triangles.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>
#include <vector>

#include "common/geometry/poly_topology/face_shape.h"

namespace strake {
namespace {

CoarseSurface surface(std::vector<Vec3> positions, std::vector<std::array<Index, 3>> faces) {
  CoarseSurface result;
  result.is_barrier.assign(3 * faces.size(), 0);
  result.positions = std::move(positions);
  result.faces = std::move(faces);
  return result;
}

/// Four triangles in a row: the two in the middle make a square, each other pair a quad that is
/// worse.
CoarseSurface strip() {
  return surface({Vec3(-1.2, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 0), Vec3(1, 1, 0), Vec3(1, 0, 0),
                  Vec3(2.2, 1, 0)},
                 {{0, 2, 1}, {1, 2, 3}, {2, 4, 3}, {3, 4, 5}});
}

Index quads_of(const PolyMesh& mesh) {
  Index quads = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) quads += mesh.face(f).size() == 4 ? 1 : 0;
  return quads;
}

void set_barrier(CoarseSurface& surface, Index a, Index b) {
  for (std::size_t h = 0; h < surface.is_barrier.size(); ++h) {
    const auto& face = surface.faces[h / 3];
    const Index from = face[h % 3];
    const Index to = face[(h + 1) % 3];
    if ((from == a && to == b) || (from == b && to == a)) surface.is_barrier[h] = 1;
  }
}

// The square first would leave two triangles.
TEST(PairTriangles, GivesUpAGoodQuadForTwo) {
  const PolyMesh result = pair_triangles(strip());
  EXPECT_EQ(result.face_count(), 2);
  EXPECT_EQ(quads_of(result), 2);
}

TEST(PairTriangles, KeepsFeatureEdges) {
  CoarseSurface coarse = strip();
  set_barrier(coarse, 1, 2);
  const PolyMesh result = pair_triangles(coarse);
  // The first triangle is alone; of the other three one stays.
  EXPECT_EQ(result.face_count(), 3);
  EXPECT_EQ(quads_of(result), 1);
  set_barrier(coarse, 2, 3);
  set_barrier(coarse, 3, 4);
  EXPECT_EQ(quads_of(pair_triangles(coarse)), 0);
}

/// A hexagon with a triangle in the middle, which only one of the others can be paired with.
TEST(PairTriangles, DividesFlatsAnew) {
  CoarseSurface hexagon = surface({Vec3(0, 0, 0), Vec3(1, -0.2, 0), Vec3(2, 0, 0), Vec3(2, 1, 0),
                                   Vec3(1, 1.2, 0), Vec3(0, 1, 0)},
                                  {{1, 3, 5}, {1, 2, 3}, {3, 4, 5}, {5, 0, 1}});
  const PolyMesh flat = pair_triangles(hexagon);
  EXPECT_EQ(flat.face_count(), 2);
  EXPECT_EQ(quads_of(flat), 2);
  CoarseSurface parted = hexagon;
  set_barrier(parted, 1, 3);
  EXPECT_LT(quads_of(pair_triangles(parted)), 2);
  hexagon.positions[3].z() = 0.2;
  EXPECT_EQ(pair_triangles(hexagon).face_count(), 3);
}

TEST(PairTriangles, FacesKeepTheirOrientation) {
  const PolyMesh result = pair_triangles(strip());
  ASSERT_GT(result.face_count(), 0);
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_GT(newell_normal(result.positions, result.face(f)).z(), 0);
  }
}

/// A unit square, folded along the diagonal that its triangles share by an angle.
CoarseSurface folded(double angle, double other_diagonal) {
  const double half = other_diagonal / 2;
  const double x = half * std::cos(angle / 2);
  const double z = half * std::sin(angle / 2);
  const double y = std::sqrt(0.5);
  return surface({Vec3(0, -y, 0), Vec3(x, 0, -z), Vec3(0, y, 0), Vec3(-x, 0, -z)},
                 {{0, 1, 2}, {0, 2, 3}});
}

TEST(PairTriangles, DoesNotPairOverAnEdge) {
  const double degree = M_PI / 180;
  EXPECT_EQ(quads_of(pair_triangles(folded(20 * degree, 1.5))), 1);
  EXPECT_EQ(quads_of(pair_triangles(folded(90 * degree, 1.5))), 0);
}

// Whoever draws the quad by its shorter diagonal draws another surface than the triangles were,
// unless they are nearly flat.
TEST(PairTriangles, DoesNotPairWhereTheOtherDiagonalDecides) {
  const double degree = M_PI / 180;
  EXPECT_EQ(quads_of(pair_triangles(folded(20 * degree, 1.2))), 0);
  EXPECT_EQ(quads_of(pair_triangles(folded(2 * degree, 1.2))), 1);
}

}  // namespace
}  // namespace strake
