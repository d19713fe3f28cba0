#include "stages/import/triangulate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <ctime>
#include <map>
#include <random>
#include <set>

#include "common/geometry/poly_topology/face_shape.h"
#include "tests/unit/import/shapes.h"

namespace strake::import {
namespace {

/// The triangles of a single polygon given by its corners.
Soup cut(const std::vector<Vec3>& corners) {
  PolyMesh mesh;
  mesh.positions = corners;
  std::vector<Index> face(corners.size());
  for (Index i = 0; i < mesh.vertex_count(); ++i) face[i] = i;
  mesh.add_face(face);
  Repairs repairs;
  return triangulate(mesh, repairs);
}

/// Checks that the triangles form a disk with the outline 0, 1, ..., n - 1.
void expect_disk(const Soup& soup, Index n) {
  ASSERT_EQ(soup.face_count(), n - 2);
  std::map<std::pair<Index, Index>, int> directed;
  for (Index h = 0; h < soup.halfedge_count(); ++h) ++directed[{soup.from(h), soup.to(h)}];
  for (const auto& [edge, times] : directed) {
    EXPECT_EQ(times, 1);
    const bool is_outline = edge.second == (edge.first + 1) % n;
    EXPECT_EQ(directed.count({edge.second, edge.first}), is_outline ? 0U : 1U);
  }
}

std::vector<double> signed_areas(const Soup& soup) {
  std::vector<double> areas;
  for (const auto& [a, b, c] : soup.faces) {
    const Vec3& p = soup.positions[a];
    areas.push_back(0.5 * (soup.positions[b] - p).cross(soup.positions[c] - p).z());
  }
  return areas;
}

TEST(Triangulate, ConcaveQuadIsCutAtItsReflexCorner) {
  // The reflex corner is number 3; only the diagonal 1-3 lies inside.
  const Soup soup = cut({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.2, 0.2, 0)});
  expect_disk(soup, 4);
  for (const double area : signed_areas(soup)) EXPECT_GT(area, 0);
}

/// Whether a quad is cut between its corners 1 and 3.
bool is_cut_from_second_corner(const std::vector<Vec3>& quad) {
  return std::ranges::all_of(cut(quad).faces, [](const Triangle& face) {
    return std::ranges::count(face, 1) == 1 && std::ranges::count(face, 3) == 1;
  });
}

TEST(Triangulate, QuadTakesTheShorterDiagonal) {
  EXPECT_TRUE(
      is_cut_from_second_corner({Vec3(0, 0, 0), Vec3(2, -1, 0), Vec3(4, 0, 0), Vec3(2, 1, 0)}));
  // Bent, so that the diagonal decides about the surface; the flattest triangle is this cut's.
  EXPECT_TRUE(is_cut_from_second_corner(
      {Vec3(-0.5, -0.2, 0), Vec3(2.5, 0.3, 0.3), Vec3(1.9, 1.5, 0), Vec3(0.2, 1.6, 0.3)}));
}

TEST(Triangulate, QuadWithAStraightCornerIsCutThere) {
  EXPECT_TRUE(
      is_cut_from_second_corner({Vec3(0, 0, 0), Vec3(1, -1e-9, 0), Vec3(2, 0, 0), Vec3(1, 3, 0)}));
}

TEST(Triangulate, StarKeepsItsAreaWithoutFoldedTriangles) {
  for (const Index n : {10, 101, 1000}) {
    std::vector<Vec3> star;
    double twice_area = 0;
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      star.push_back((i % 2 == 0 ? 1.0 : 0.3) * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    for (Index i = 0; i < n; ++i) twice_area += star[i].cross(star[(i + 1) % n]).z();
    const Soup soup = cut(star);
    expect_disk(soup, n);
    double sum = 0;
    for (const double area : signed_areas(soup)) {
      EXPECT_GT(area, 0);
      sum += area;
    }
    // n sums of numbers below 1, each rounded to 1e-16.
    EXPECT_NEAR(sum, 0.5 * twice_area, 1e-15 * n);
  }
}

/// Processor time of cutting a star of so many low points, and a quad.
double time_to_cut(int points) {
  PolyMesh mesh = shapes::polygons({Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(3, 1, 0), Vec3(2, 1, 0)},
                                   {{0, 1, 2, 3}});
  std::vector<Index> star;
  for (int i = 0; i < 2 * points; ++i) {
    const double angle = std::numbers::pi * i / points;
    star.push_back(mesh.vertex_count());
    mesh.positions.push_back((i % 2 == 0 ? 1.02 : 1.0) * Vec3(std::cos(angle), std::sin(angle), 0));
  }
  mesh.add_face(star);
  Repairs repairs;
  const std::clock_t start = std::clock();
  EXPECT_EQ(triangulate(mesh, repairs).face_count(), 2 * points);
  return static_cast<double>(std::clock() - start);
}

// Eight times the corners took 60 times as long.
TEST(Triangulate, LargePolygonsTakeLittleMoreForEachCorner) {
  const double few = std::min({time_to_cut(4000), time_to_cut(4000), time_to_cut(4000)});
  EXPECT_LT(time_to_cut(32000), 30 * few);
}

TEST(Triangulate, AnyOutlineGivesADisk) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 200; ++trial) {
    const Index n = 5 + trial % 40;
    std::vector<Vec3> corners;
    for (Index i = 0; i < n; ++i) {
      corners.emplace_back(uniform(random), uniform(random), trial % 2 == 0 ? 0 : uniform(random));
    }
    expect_disk(cut(corners), n);
  }
}

// So a mesh of polygons is the same surface for whoever measures its distance to the result.
TEST(Triangulate, CutsAsFacesOfResultsAreMeasured) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int trial = 0; trial < 300; ++trial) {
    const Index n = 4 + trial % 6;
    std::vector<Vec3> corners;
    for (Index i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * i / n;
      corners.emplace_back((1 + 0.3 * uniform(random)) * std::cos(angle),
                           (1 + 0.3 * uniform(random)) * std::sin(angle), 0.2 * uniform(random));
    }
    std::vector<Index> face(corners.size());
    std::iota(face.begin(), face.end(), 0);
    std::vector<Triangle> measured;
    triangulate_face(corners, face, measured);
    std::vector<Triangle> own = cut(corners).faces;
    for (auto* triangles : {&own, &measured}) {
      for (Triangle& triangle : *triangles) std::ranges::sort(triangle);
      std::ranges::sort(*triangles);
    }
    EXPECT_EQ(own, measured) << trial;
  }
}

TEST(Triangulate, CollinearAndCoincidentCorners) {
  expect_disk(cut({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(2, 1, 0), Vec3(1, 1, 0),
                   Vec3(0, 1, 0), Vec3(0, 0.5, 0)}),
              7);
  expect_disk(cut(std::vector<Vec3>(6, Vec3(1, 2, 3))), 6);
  expect_disk(cut({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(3, 0, 0), Vec3(4, 0, 0)}), 5);
}

TEST(Triangulate, RepeatedCornersOfPolygonsAreLeftOut) {
  Repairs repairs;
  const Soup soup = triangulate(
      shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 0, 1, 2}, {0, 1, 1, 0}}),
      repairs);
  EXPECT_EQ(soup.face_count(), 1);
  EXPECT_EQ(repairs.degenerate_faces, 1);
}

TEST(Triangulate, QuadsThatShareThreeCornersGetDifferentDiagonals) {
  // Two quads back to back around a vertex of two edges: with the diagonal 1-3 in both, the
  // triangle (1, 2, 3) would be there twice.
  Repairs repairs;
  const Soup soup = triangulate(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0.1),
                                                  Vec3(0, 1, 0), Vec3(2, 2, 0)},
                                                 {{0, 1, 2, 3}, {4, 3, 2, 1}}),
                                repairs);
  std::set<Triangle> distinct;
  for (Triangle face : soup.faces) {
    std::sort(face.begin(), face.end());
    distinct.insert(face);
  }
  EXPECT_EQ(distinct.size(), 4U);
}

}  // namespace
}  // namespace strake::import
