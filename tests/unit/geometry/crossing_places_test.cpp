#include "common/geometry/face_crossings/crossing_places.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>

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
/// Faces of parts are large: what is only in the box around two of them is not on them.
TEST(CrossingPlaces, AreBesideLargeFacesOfTheInputThatCross) {
  const TriMesh surface = triangles_of(two_squares(Vec3::Zero(), -0.3));
  CrossingPlaces crossing(surface);
  PolyMesh result;
  const auto at = [](double x, double y, double z) { return Vec3(x, 0.6 + y, 0.4 + z); };
  add_square(result, at(-0.1, -0.1, 0), at(0.1, -0.1, 0), at(0.1, 0.1, 0), at(-0.1, 0.1, 0));
  add_square(result, at(0, -0.05, -0.1), at(0, 0.05, -0.1), at(0, 0.05, 0.1), at(0, -0.05, 0.1));
  EXPECT_EQ(crossing.faces_of(result).size(), 2u);
}

/// Squares through the plane z = 0, so many along x and along y, which pass through each other.
PolyMesh with_uprights(int along_x, int along_y) {
  PolyMesh result;
  add_square(result, Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0));
  for (int i = 0; i < along_x; ++i) add_upright(result, 0, 0.001 * i, 0.5);
  for (int i = 0; i < along_y; ++i) {
    const double x = 0.001 * i;
    add_square(result, Vec3(x, -0.5, -0.5), Vec3(x, 0.5, -0.5), Vec3(x, 0.5, 0.5),
               Vec3(x, -0.5, 0.5));
  }
  return result;
}

TEST(CrossingPlaces, AreWhereCellsAreTangledAlthoughTheInputCrossesItself) {
  const TriMesh surface = triangles_of(two_squares(Vec3::Zero(), -0.3));
  CrossingPlaces crossing(surface, Tangles::kFaults);
  EXPECT_TRUE(crossing.faces_of(with_uprights(5, 0)).empty());
  EXPECT_TRUE(crossing.faces_of(with_uprights(60, 0)).empty());  // finer, and not tangled
  EXPECT_EQ(crossing.faces_of(with_uprights(10, 10)).size(), 21u);
  EXPECT_TRUE(CrossingPlaces(surface).faces_of(with_uprights(10, 10)).empty());
}

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

// Where the input has no edges that sheets share cells that touch are tangled.
TEST(CrossingPlaces, AreWhereFacesTouchThatDoNotInTheInput) {
  const TriMesh surface = triangles_of(two_squares(Vec3::Zero(), 0.1));
  EXPECT_EQ(CrossingPlaces(surface).of(two_squares(Vec3::Zero(), 0)).size(), 2u);
}

/// A strip of so many squares around the z axis, and of so many rings of them.
/// \param at  place of a corner, by its number around and that of its ring
PolyMesh closed_strip(Index sides, Index rings, const std::function<Vec3(Index, Index)>& at) {
  PolyMesh mesh;
  for (Index k = 0; k <= rings; ++k) {
    for (Index i = 0; i < sides; ++i) mesh.positions.push_back(at(i, k));
  }
  for (Index k = 0; k < rings; ++k) {
    for (Index i = 0; i < sides; ++i) {
      const Index next = (i + 1) % sides;
      mesh.add_face(std::array<Index, 4>{k * sides + i, k * sides + next, (k + 1) * sides + next,
                                         (k + 1) * sides + i});
    }
  }
  return mesh;
}

/// A pipe of radius 1, from z = -1 to 1, and a flange around its middle.
/// \param sides  of both, a divisor of 64
/// \param turn   of the flange, in 64ths of a full turn
/// \param inner  radius of the flange
PolyMesh flanged_pipe(Index sides, Index rings, Index turn, double inner) {
  constexpr Index kSides = 64;
  const auto around = [&](Index i, double radius, double z) {
    const double angle = 2 * std::numbers::pi * (i % kSides) / kSides;
    return Vec3(radius * std::cos(angle), radius * std::sin(angle), z);
  };
  const Index step = kSides / sides;
  return support::together(
      closed_strip(sides, rings,
                   [&](Index i, Index k) { return around(step * i, 1, -1 + 2.0 * k / rings); }),
      closed_strip(sides, 1, [&](Index i, Index k) {
        return around(step * i + turn, k == 0 ? inner : 1.5, 0);
      }));
}

// Chords of the common circle are apart by 2 % of the radius.
TEST(CrossingPlaces, AreNotAlongCurvesThatSheetsShare) {
  const TriMesh surface = triangles_of(flanged_pipe(64, 2, 0, 1));
  CrossingPlaces crossing(surface);
  const MeetingFaces touching = crossing.meeting(flanged_pipe(16, 1, 2, 1));
  EXPECT_FALSE(touching.all.empty());
  EXPECT_TRUE(touching.crossing.empty());
  EXPECT_FALSE(crossing.of(flanged_pipe(16, 1, 2, 0.7)).empty());
  // A flange around a pipe that it does not touch passes through it.
  const TriMesh loose = triangles_of(flanged_pipe(64, 2, 0, 1.001));
  EXPECT_FALSE(CrossingPlaces(loose).of(flanged_pipe(16, 1, 2, 1)).empty());
}

}  // namespace
}  // namespace strake
