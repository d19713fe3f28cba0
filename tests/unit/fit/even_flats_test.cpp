#include "stages/fit/even_flats.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "common/core/fields.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "stages/fit/vertex_places.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/fit/fit_cases.h"

namespace strake {
namespace {

constexpr double kOff = 1e-6;
constexpr Index kSides = 12;

/// A grid of kSides x kSides quads over the unit square.
PolyMesh grid(const std::function<Vec3(double x, double y)>& place) {
  PolyMesh mesh;
  for (Index j = 0; j <= kSides; ++j) {
    for (Index i = 0; i <= kSides; ++i) {
      mesh.positions.push_back(place(double(i) / kSides, double(j) / kSides));
    }
  }
  for (Index j = 0; j < kSides; ++j) {
    for (Index i = 0; i < kSides; ++i) {
      const Index v = j * (kSides + 1) + i;
      mesh.add_face(std::vector<Index>{v, v + 1, v + kSides + 2, v + kSides + 1});
    }
  }
  return mesh;
}

/// The same square with lines that crowd towards a corner, but for those on the outline.
Vec3 crowded(double x, double y) {
  const double inside = 16 * x * (1 - x) * y * (1 - y);
  return {x - 0.25 * inside * x, y - 0.25 * inside * y, 0};
}

/// What is remeshed: the triangles of a mesh.
TriMesh surface_of(const PolyMesh& mesh) {
  PolyMesh triangles;
  triangles.positions = mesh.positions;
  for (const auto& corners : triangulate_faces(mesh, mesh.positions).corners) {
    triangles.add_face(corners);
  }
  return support::plain_tri_mesh(triangles);
}

struct Evened {
  std::vector<Vec3> positions;
  Index moved = 0;
};

/// \param result  is put onto the surface first
Evened evened(const PolyMesh& surface, const PolyMesh& result, double off = kOff) {
  const TriMesh mesh = surface_of(surface);
  const QuadMesh quads = fit_cases::placed_on(mesh, result);
  const SurfaceDistance distance(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, distance, quads);
  const Index moved = fitting::even_flats(quads.mesh, nullptr, off, places);
  std::vector<Vec3> positions = places.positions();
  for (Vec3& p : positions) p += mesh.origin;
  return {positions, moved};
}

double farthest(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double distance = 0;
  for (std::size_t v = 0; v < a.size(); ++v) distance = std::max(distance, (a[v] - b[v]).norm());
  return distance;
}

// The middle of the neighbours everywhere is a discrete harmonic map, and on a square with even
// sides that is the even grid.
TEST(EvenFlats, SpreadAGridEvenly) {
  const PolyMesh even = grid([](double x, double y) { return Vec3(x, y, 0); });
  const PolyMesh uneven = grid(crowded);
  const Evened result = evened(even, uneven);
  EXPECT_EQ(result.moved, (kSides - 1) * (kSides - 1));
  EXPECT_GT(farthest(uneven.positions, even.positions), 1.5 / kSides);
  EXPECT_LT(farthest(result.positions, even.positions), 0.1 / kSides);
}

TEST(EvenFlats, StayInAnObliquePlane) {
  const Mat3 rotation = support::oblique_rotation();
  const PolyMesh even = grid([&](double x, double y) { return Vec3(rotation * Vec3(x, y, 0)); });
  const PolyMesh uneven = grid([&](double x, double y) { return Vec3(rotation * crowded(x, y)); });
  const Evened result = evened(even, uneven);
  EXPECT_GT(result.moved, 0);
  for (const Vec3& p : result.positions) EXPECT_NEAR((rotation.transpose() * p).z(), 0, 1e-12);
}

TEST(EvenFlats, LeaveTheOutlineAlone) {
  const PolyMesh even = grid([](double x, double y) { return Vec3(x, y, 0); });
  const Evened result = evened(even, grid(crowded));
  for (std::size_t v = 0; v < even.positions.size(); ++v) {
    const Vec3& p = even.positions[v];
    if (std::min({p.x(), p.y(), 1 - p.x(), 1 - p.y()}) > 0) continue;
    EXPECT_LT((result.positions[v] - p).norm(), 1e-12);
  }
}

TEST(EvenFlats, LeaveCurvedSurfacesAlone) {
  const auto bent = [](const Vec3& p) { return Vec3(std::sin(p.x()), p.y(), std::cos(p.x())); };
  const PolyMesh even = grid([&](double x, double y) { return bent(Vec3(x, y, 0)); });
  const PolyMesh uneven = grid([&](double x, double y) { return bent(crowded(x, y)); });
  EXPECT_EQ(evened(even, uneven).moved, 0);
}

// One vertex that is off the plane keeps those of the faces around it, as it is there for the
// height that it shows.
TEST(EvenFlats, LeaveWhatIsAroundAVertexOffThePlane) {
  const PolyMesh even = grid([](double x, double y) { return Vec3(x, y, 0); });
  const TriMesh mesh = surface_of(even);
  QuadMesh quads = fit_cases::placed_on(mesh, grid(crowded));
  const Index middle = kSides / 2 * (kSides + 1) + kSides / 2;
  quads.mesh.positions[middle].z() = 0.01;
  const SurfaceDistance distance(mesh.positions, mesh.faces);
  fitting::VertexPlaces places(mesh, distance, quads);
  EXPECT_EQ(fitting::even_flats(quads.mesh, nullptr, kOff, places),
            (kSides - 1) * (kSides - 1) - 9);
  for (const Index row : {-1, 0, 1}) {
    for (const Index column : {-1, 0, 1}) {
      const Index v = middle + row * (kSides + 1) + column;
      EXPECT_EQ(places.positions()[v], quads.mesh.positions[v] - mesh.origin);
    }
  }
}

/// The largest turn of an edge of the grid's upright lines away from the y axis, radians.
double largest_lean(const std::vector<Vec3>& positions) {
  double largest = 0;
  for (Index v = 0; v + kSides + 1 < static_cast<Index>(positions.size()); ++v) {
    const Vec3 edge = positions[v + kSides + 1] - positions[v];
    largest = std::max(largest, std::atan2(std::abs(edge.x()), edge.y()));
  }
  return largest;
}

// The upper side of the square is divided unevenly. Lines have to lean on their way there: near it
// where only evenness counts, all the way and so less where they belong to a field.
TEST(EvenFlats, KeepLinesAlongTheField) {
  const TriMesh mesh = surface_of(grid([](double x, double y) { return Vec3(x, y, 0); }));
  const QuadMesh quads = fit_cases::placed_on(
      mesh,
      grid([](double x, double y) { return Vec3(x - (y == 1 ? 0.15 * x * (1 - x) : 0), y, 0); }));
  PrincipalField field;
  field.mesh_id = mesh.id;
  field.normal.assign(mesh.wedge_count(), Vec3(0, 0, 1));
  field.cross.assign(mesh.wedge_count(), Vec3(1, 0, 0));
  const SurfaceDistance distance(mesh.positions, mesh.faces);
  const auto lean = [&](const PrincipalField* along) {
    fitting::VertexPlaces places(mesh, distance, quads, &field);
    fitting::even_flats(quads.mesh, along, kOff, places);
    return largest_lean(places.positions());
  };
  EXPECT_LT(lean(&field), 0.75 * lean(nullptr));
}

// Inside an arrowhead the middle of the four corners lies outside.
TEST(EvenFlats, TurnNoFaceOver) {
  PolyMesh arrow;
  arrow.positions = {Vec3(0, 3, 0), Vec3(-3, -3, 0), Vec3(0, 1, 0), Vec3(3, -3, 0),
                     Vec3(0.4, 2, 0)};
  for (const auto& face : {std::array<Index, 3>{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}) {
    arrow.add_face(face);
  }
  const Evened result = evened(arrow, arrow);
  for (Index f = 0; f < arrow.face_count(); ++f) {
    const auto area = [&](const std::vector<Vec3>& p) {
      const std::span<const Index> face = arrow.face(f);
      return (p[face[1]] - p[face[0]]).cross(p[face[2]] - p[face[0]]).z();
    };
    EXPECT_GT(area(result.positions), 0.3 * area(arrow.positions)) << f;
  }
}

}  // namespace
}  // namespace strake
