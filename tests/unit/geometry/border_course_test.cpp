#include "common/geometry/border_course.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// Teeth along the outer border of the ring below, so high over the middle.
constexpr int kTeeth = 60;
constexpr double kHeight = 0.02;

/// A flat ring between circles of radius 1 and 2, the outer one a saw of triangles.
PolyMesh saw_ring(double height = kHeight) {
  PolyMesh faces;
  constexpr int kCount = 2 * kTeeth;
  for (const double radius : {1.0, 2.0}) {
    for (int i = 0; i < kCount; ++i) {
      const double angle = 2 * M_PI * i / kCount;
      const double tooth = radius < 2 ? 0 : (i % 2 == 0 ? height : -height);
      faces.positions.emplace_back((radius + tooth) * std::cos(angle),
                                   (radius + tooth) * std::sin(angle), 0);
    }
  }
  for (Index i = 0; i < kCount; ++i) {
    const Index next = (i + 1) % kCount;
    faces.add_face(std::array<Index, 3>{i, kCount + i, kCount + next});
    faces.add_face(std::array<Index, 3>{i, kCount + next, next});
  }
  return faces;
}

/// The outline of a polygon, fanned from its middle, with so many vertices on each side.
PolyMesh fan(const std::vector<Vec3>& outline, int on_side) {
  PolyMesh faces;
  faces.positions.push_back(Vec3::Zero());
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Vec3& a = outline[i];
    const Vec3& b = outline[(i + 1) % outline.size()];
    for (int k = 0; k < on_side; ++k) faces.positions.push_back(a + (b - a) * k / on_side);
  }
  const auto count = static_cast<Index>(faces.positions.size()) - 1;
  for (Index i = 0; i < count; ++i) {
    faces.add_face(std::array<Index, 3>{0, 1 + i, 1 + (i + 1) % count});
  }
  return faces;
}

std::vector<double> all(const TriMesh& mesh, double size) {
  return std::vector<double>(mesh.positions.size(), size);
}

TEST(BorderCourse, GoesThroughTheMiddleOfTeeth) {
  const TriMesh mesh = support::plain_tri_mesh(saw_ring());
  // Teeth are 0.2 wide. The mean of a circle over a reach r to both sides is r² / 12 R further in:
  // along the saw that is at most half a cell times its length over the straight way, 1.3.
  const double size = 0.6;
  const double further_in = std::pow(0.5 * size * 1.3, 2) / (12 * 2);
  const BorderCourse course = border_course(mesh, all(mesh, size), 1);
  ASSERT_EQ(course.offset.size(), mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const double radius = mesh.positions[v].norm();
    if (radius < 1.5) {
      EXPECT_TRUE(course.offset[v].isZero(0));
      continue;
    }
    EXPECT_NEAR(course.place(mesh, v).norm(), 2, further_in + 0.1 * kHeight);
    // Along the circle, the surface on the left: counter-clockwise.
    EXPECT_GT(course.direction[v].dot(Vec3(0, 0, 1).cross(mesh.positions[v] / radius)), 0.99);
  }
}

TEST(BorderCourse, KeepsTeethAsWideAsCellsOrTooHigh) {
  const TriMesh mesh = support::plain_tri_mesh(saw_ring());
  EXPECT_TRUE(border_course(mesh, all(mesh, 0.15), 1).offset.empty());
  EXPECT_TRUE(border_course(mesh, all(mesh, 0.6), 0.5 * kHeight).offset.empty());
  EXPECT_FALSE(border_course(mesh, all(mesh, 0.6), 2 * kHeight).offset.empty());
}

// 0.75 % of the diagonal are seen, however large cells are.
TEST(BorderCourse, KeepsTeethThatAreSeen) {
  const TriMesh mesh = support::plain_tri_mesh(saw_ring(0.02));
  const TriMesh higher = support::plain_tri_mesh(saw_ring(0.04));
  EXPECT_FALSE(border_course(mesh, all(mesh, 0.8), 1).offset.empty());
  EXPECT_TRUE(border_course(higher, all(higher, 0.8), 1).offset.empty());
}

TEST(BorderCourse, LeavesOutCornersOfTeeth) {
  TriMesh mesh = support::plain_tri_mesh(saw_ring());
  const Index tip = 2 * kTeeth;
  mesh.is_corner[tip] = 1;
  EXPECT_EQ(border_course(mesh, all(mesh, 0.6), 1).is_corner[tip], 0);
  EXPECT_EQ(border_course(mesh, all(mesh, 0.15), 1).is_corner[tip], 1);
}

/// What a saw is not, with cells much larger than all of it: polygons, and teeth with a top.
TEST(BorderCourse, IsTheBoundaryOfPlainShapes) {
  std::vector<Vec3> gear;
  for (int i = 0; i < 80; ++i) {
    const double angle = 2 * M_PI * i / 80;
    const double radius = i % 4 < 2 ? 1 : 0.9;
    gear.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
  }
  std::vector<Vec3> circle;
  for (int i = 0; i < 12; ++i) {
    circle.emplace_back(std::cos(M_PI * i / 6), std::sin(M_PI * i / 6), 0);
  }
  const std::vector<Vec3> square = {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)};
  for (const auto& outline : {gear, circle, square}) {
    for (const int on_side : {1, 3}) {
      const TriMesh mesh = support::plain_tri_mesh(fan(outline, on_side));
      EXPECT_TRUE(ragged_directions(mesh).empty()) << outline.size() << ", " << on_side;
      EXPECT_TRUE(border_course(mesh, all(mesh, 10), 10).offset.empty());
    }
  }
}

TEST(BorderCourse, ChangesLinearlyAlongEdges) {
  const TriMesh mesh = support::plain_tri_mesh(saw_ring());
  const BorderCourse course = border_course(mesh, all(mesh, 0.6), 1);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h) || !course.is_off(mesh, h)) continue;
    SurfacePoint point{TriMesh::face_of(h), {0, 0, 0}};
    point.barycentric[h % 3] = 0.75;
    point.barycentric[TriMesh::next(h) % 3] = 0.25;
    const Vec3 expected = 0.75 * course.offset[mesh.from(h)] + 0.25 * course.offset[mesh.to(h)];
    EXPECT_LT((course.offset_at(mesh, point) - expected).norm(), 1e-15);
    point.barycentric = {1.0 / 3, 1.0 / 3, 1.0 / 3};
    EXPECT_TRUE(course.offset_at(mesh, point).isZero(0));
  }
}

}  // namespace
}  // namespace strake
