#include "common/geometry/face_crossings/crossing_places.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

void add_square(PolyMesh& mesh, const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const Index first = mesh.vertex_count();
  mesh.positions.insert(mesh.positions.end(), {a, b, c, d});
  mesh.add_face(std::array<Index, 4>{first, first + 1, first + 2, first + 3});
}

/// A square in the plane z = 0 around `middle`, and one that stands on it or passes through it.
PolyMesh two_squares(const Vec3& middle, double lowest) {
  PolyMesh mesh;
  const auto at = [&](double x, double y, double z) { return Vec3(middle + Vec3(x, y, z)); };
  add_square(mesh, at(-1, -1, 0), at(1, -1, 0), at(1, 1, 0), at(-1, 1, 0));
  add_square(mesh, at(-0.5, 0, lowest), at(0.5, 0, lowest), at(0.5, 0, lowest + 1),
             at(-0.5, 0, lowest + 1));
  return mesh;
}

TriMesh triangles_of(const PolyMesh& mesh) {
  PolyMesh triangles;
  triangles.positions = mesh.positions;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    triangles.add_face(std::array<Index, 3>{face[0], face[1], face[2]});
    triangles.add_face(std::array<Index, 3>{face[0], face[2], face[3]});
  }
  return support::plain_tri_mesh(triangles);
}

const Vec3 kHere(3, 1, -2);

TEST(CrossingPlaces, AreTheMiddlesOfFacesThatCross) {
  TriMesh surface = triangles_of(two_squares(Vec3::Zero(), 0.1));
  surface.origin = kHere;
  CrossingPlaces crossing(surface);
  EXPECT_TRUE(crossing.of(two_squares(kHere, 0.1)).empty());
  const std::vector<Vec3> places = crossing.of(two_squares(kHere, -0.3));
  ASSERT_EQ(places.size(), 2u);
  EXPECT_LT((places[0] - Vec3(0, 0, 0)).norm(), 1e-12);
  EXPECT_LT((places[1] - Vec3(0, 0, 0.2)).norm(), 1e-12);
}

TEST(CrossingPlaces, AreNotWhereTheInputCrossesItself) {
  const TriMesh surface =
      triangles_of(support::together(two_squares(Vec3::Zero(), -0.3), two_squares(kHere, 0.1)));
  CrossingPlaces crossing(surface);
  EXPECT_TRUE(crossing.of(two_squares(Vec3::Zero(), -0.3)).empty());
  EXPECT_EQ(crossing.of(two_squares(kHere, -0.3)).size(), 2u);
}

TEST(CrossingPlaces, TellSheetsOnTopOfEachOtherFromFew) {
  const TriMesh surface = triangles_of(two_squares(Vec3::Zero(), 0.1));
  CrossingPlaces crossing(surface);
  PolyMesh copies = two_squares(Vec3::Zero(), -0.3);
  crossing.of(copies);
  EXPECT_FALSE(crossing.is_stacked());  // one pair of two faces
  for (int i = 0; i < 3; ++i) copies = support::together(copies, two_squares(Vec3::Zero(), -0.3));
  crossing.of(copies);
  EXPECT_TRUE(crossing.is_stacked());  // each upright one passes through four
  crossing.of(two_squares(Vec3::Zero(), 0.1));
  EXPECT_FALSE(crossing.is_stacked());
}

/// An upright square of half this size through the plane z = 0.
void add_upright(PolyMesh& mesh, double x, double y, double half) {
  add_square(mesh, Vec3(x - half, y, -half), Vec3(x + half, y, -half), Vec3(x + half, y, half),
             Vec3(x - half, y, half));
}

// The small one of two faces may be too far from where the input crosses itself.
TEST(CrossingPlaces, AreNotWhereEitherFaceIsNearACrossingOfTheInput) {
  PolyMesh tiles;
  for (const double x : {-1.0, 0.0}) {
    for (const double y : {-1.0, 0.0}) {
      add_square(tiles, Vec3(x, y, 0), Vec3(x + 1, y, 0), Vec3(x + 1, y + 1, 0), Vec3(x, y + 1, 0));
    }
  }
  add_upright(tiles, 0.5, 0.5, 0.1);
  const TriMesh surface = triangles_of(tiles);
  PolyMesh result;
  add_square(result, Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0));
  add_upright(result, -0.5, -0.5, 0.1);
  EXPECT_TRUE(CrossingPlaces(surface).of(result).empty());
}

/// The input is looked at around one place after the other, and at last everywhere.
TEST(CrossingPlaces, AreTheSameHoweverManyWereAskedForBefore) {
  constexpr int kPlaces = 14;
  const auto middle = [](int i) { return Vec3(10 * i, 0, 0); };
  const auto crosses_itself = [](int i) { return i % 3 == 0; };
  PolyMesh all;
  for (int i = 0; i < kPlaces; ++i) {
    all = support::together(all, two_squares(middle(i), crosses_itself(i) ? -0.3 : 0.1));
  }
  const TriMesh surface = triangles_of(all);
  CrossingPlaces crossing(surface);
  for (const int round : {0, 1}) {
    for (int i = 0; i < kPlaces; ++i) {
      EXPECT_EQ(crossing.of(two_squares(middle(i), -0.3)).empty(), crosses_itself(i))
          << "place " << i << ", round " << round;
    }
  }
}

}  // namespace
}  // namespace strake
