#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <vector>

#include "common/geometry/angles.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/patch_fill/fill_polygon.h"
#include "common/geometry/patch_fill/refill_crossing.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/surface_lines.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using Triangles = std::vector<std::array<Index, 3>>;

constexpr auto kAnyEdge = [](std::size_t, std::size_t) { return true; };

Triangles fill(const std::vector<Vec3>& corners) {
  return fill_polygon(corners, std::vector<Vec3>(corners.size(), Vec3::Zero()), kAnyEdge);
}

Vec3 vector_area(const std::vector<Vec3>& corners, const std::array<Index, 3>& t) {
  return (corners[t[1]] - corners[t[0]]).cross(corners[t[2]] - corners[t[0]]) / 2;
}

TEST(FillPolygon, CoversAFlatOneOnce) {
  // Not convex: the sum of areas without sign is that of the polygon only where none overlap.
  const std::vector<Vec3> corners = {{0, 0, 0}, {3, 0, 0}, {3, 1, 0},
                                     {1, 1, 0}, {1, 3, 0}, {0, 3, 0}};
  const Triangles triangles = fill(corners);
  ASSERT_EQ(triangles.size(), corners.size() - 2);
  double area = 0;
  for (const auto& t : triangles) {
    EXPECT_GT(vector_area(corners, t).z(), 0);
    area += vector_area(corners, t).norm();
  }
  EXPECT_NEAR(area, 5, 1e-12);
}

TEST(FillPolygon, AvoidsSlivers) {
  // On each side of a square lie three corners in a row.
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0},
                                     {2, 2, 0}, {1, 2, 0}, {0, 2, 0}, {0, 1, 0}};
  const Triangles triangles = fill(corners);
  ASSERT_EQ(triangles.size(), 6u);
  for (const auto& [a, b, c] : triangles) {
    EXPECT_GT(smallest_angle(corners[a], corners[b], corners[c]), std::numbers::pi / 180);
  }
}

TEST(FillPolygon, GoesOnFromTheFacesAround) {
  // Four corners have a ridge along one diagonal or a valley along the other; the faces beyond fall
  // off to both sides of one of them.
  const std::vector<Vec3> corners = {{0, 0, 0}, {1, 0, 0.1}, {1, 1, 0}, {0, 1, 0.1}};
  const Vec3 one = Vec3(1, -1, 1).normalized();
  const Vec3 other = Vec3(-1, 1, 1).normalized();
  const auto corners_at_both_ends = [&](const std::vector<Vec3>& beyond) {
    std::set<Index> shared;
    const Triangles triangles = fill_polygon(corners, beyond, kAnyEdge);
    for (const Index v : triangles.at(0)) {
      if (std::ranges::count(triangles.at(1), v) == 1) shared.insert(v);
    }
    return shared;
  };
  EXPECT_EQ(corners_at_both_ends({other, other, one, one}), (std::set<Index>{0, 2}));
  const Vec3 up = Vec3(1, 1, 1).normalized();
  const Vec3 down = Vec3(-1, -1, 1).normalized();
  EXPECT_EQ(corners_at_both_ends({down, up, up, down}), (std::set<Index>{1, 3}));
}

TEST(FillPolygon, LeavesOutEdgesThatMayNotBe) {
  const std::vector<Vec3> corners = {{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
  const std::vector<Vec3> none(4, Vec3::Zero());
  const Triangles other =
      fill_polygon(corners, none, [](std::size_t i, std::size_t j) { return i != 0 || j != 2; });
  ASSERT_EQ(other.size(), 2u);
  for (const auto& t : other) EXPECT_EQ(std::ranges::count(t, 1) + std::ranges::count(t, 3), 2);
  EXPECT_TRUE(fill_polygon(corners, none, [](std::size_t, std::size_t) { return false; }).empty());
}

constexpr Index kSize = 8;         ///< squares along a side of the grid
constexpr double kCell = 1.0 / 8;  ///< side of a square

Index at(Index i, Index j) { return j * (kSize + 1) + i; }

/// Squares over a height, and a result that is the same but for vertices that are moved.
struct Grid : support::Case {
  /// \param height  over the unit square
  template <class Height>
  explicit Grid(Height height) : support::Case(support::grid(kSize, kSize, height)) {}

  void move(Index vertex, const Vec3& place) { quads.mesh.positions[vertex] = place; }

  /// Makes the edges along a row of vertices features.
  void mark_row(Index j) {
    for (std::size_t h = 0; h < mesh.twin.size(); ++h) {
      const auto half = static_cast<Index>(h);
      const auto is_in_row = [&](Index v) { return v / (kSize + 1) == j; };
      mesh.is_feature[h] = is_in_row(mesh.from(half)) && is_in_row(mesh.to(half)) ? 1 : 0;
    }
    build_wedges(mesh);
  }

  Index refill(double reach) {
    const SurfaceDistance surface(mesh.positions, mesh.faces);
    return refill_crossing_faces(mesh, surface, quads, reach);
  }
  [[nodiscard]] std::size_t crossings() const {
    return find_crossing_faces(quads.mesh.positions, triangulate_faces(quads.mesh)).size();
  }
  [[nodiscard]] std::set<std::set<std::array<double, 3>>> faces() const {
    std::set<std::set<std::array<double, 3>>> faces;
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      std::set<std::array<double, 3>> corners;
      for (const Index v : quads.mesh.face(f)) {
        const Vec3& p = quads.mesh.positions[v];
        corners.insert({p.x(), p.y(), p.z()});
      }
      faces.insert(corners);
    }
    return faces;
  }
};

double flat(double, double) { return 0; }
double roof(double, double y) { return -0.8 * std::abs(y - 0.5); }

TEST(RefillCrossingFaces, UnfoldsASheet) {
  Grid grid(flat);
  grid.move(at(4, 4), Vec3(0.7, 0.54, 0));
  ASSERT_GT(grid.crossings(), 0u);
  const auto before = grid.faces();
  const PolyTopology topology = analyse(grid.quads.mesh);
  EXPECT_GT(grid.refill(0.01), 0);
  EXPECT_EQ(grid.crossings(), 0u);
  const PolyTopology now = analyse(grid.quads.mesh);
  EXPECT_TRUE(now.is_oriented_manifold());
  EXPECT_EQ(now.euler, topology.euler);
  EXPECT_EQ(now.boundary_loops, topology.boundary_loops);
  EXPECT_EQ(now.unused_vertices, 0);
  double area = 0;
  for (Index f = 0; f < grid.quads.mesh.face_count(); ++f) {
    const Vec3 normal = newell_normal(grid.quads.mesh.positions, grid.quads.mesh.face(f));
    EXPECT_GT(normal.z(), 0);
    area += normal.norm() / 2;
  }
  EXPECT_NEAR(area, 1, 1e-12);
  // Faces two rings away are as they were.
  const auto after = grid.faces();
  std::size_t kept = 0;
  for (const auto& face : before) kept += after.count(face);
  EXPECT_GE(kept, 64u - 36u);
  ASSERT_EQ(grid.quads.provenance.face.size(), grid.quads.mesh.positions.size());
  for (std::size_t v = 0; v < grid.quads.mesh.positions.size(); ++v) {
    const Vec3 foot =
        place_of(grid.mesh, {grid.quads.provenance.face[v], grid.quads.provenance.barycentric[v]});
    const bool is_the_moved = foot == Vec3(0.5, 0.5, 0);
    EXPECT_TRUE(is_the_moved || foot == grid.quads.mesh.positions[v]) << v;
  }
}

TEST(RefillCrossingFaces, JoinsTrianglesToQuads) {
  Grid grid(flat);
  grid.move(at(4, 4), Vec3(0.7, 0.54, 0));
  grid.refill(0.01);
  std::size_t quads = 0;
  const PolyMesh& mesh = grid.quads.mesh;
  for (Index f = 0; f < mesh.face_count(); ++f) quads += mesh.face(f).size() == 4 ? 1 : 0;
  EXPECT_GT(static_cast<double>(quads), 0.9 * static_cast<double>(mesh.face_count()));
}

TEST(RefillCrossingFaces, LeavesAloneWhatCrossesNothing) {
  Grid grid([](double x, double y) { return 0.04 * std::sin(8 * x + 16 * y); });
  const std::vector<Index> corners = grid.quads.mesh.corners;
  EXPECT_EQ(grid.refill(1), 0);
  EXPECT_EQ(grid.quads.mesh.corners, corners);
}

TEST(RefillCrossingFaces, DoesNotCutOffWhatIsOutOfReach) {
  // A spike, the faces of one side of which are pushed through the other; faces across its foot
  // would be near enough to its sides.
  const Vec3 tip(0.5, 0.5, 0.4);
  for (const double reach : {0.15, 1.0}) {
    Grid grid([&](double x, double y) { return x == tip.x() && y == tip.y() ? tip.z() : 0.0; });
    grid.move(at(3, 4), Vec3(0.72, 0.5, 0.01));
    grid.move(at(4, 3), Vec3(0.5, 0.72, 0.01));
    ASSERT_GT(grid.crossings(), 0u);
    grid.refill(reach);
    EXPECT_EQ(std::ranges::count(grid.quads.mesh.positions, tip), reach < 0.4 ? 1 : 0);
  }
}

TEST(RefillCrossingFaces, MakesNoFacesOutOfReach) {
  // A fold in a result that is off the surface as a whole.
  for (const double reach : {0.1, 0.35}) {
    Grid grid(flat);
    grid.move(at(4, 4), Vec3(0.7, 0.54, 0));
    for (Vec3& p : grid.quads.mesh.positions) p.z() = 0.3;
    ASSERT_GT(grid.crossings(), 0u);
    EXPECT_EQ(grid.refill(reach) > 0, reach > 0.3);
  }
}

TEST(RefillCrossingFaces, KeepsFeatureLines) {
  // A roof with its ridge in row 4, over which a vertex of row 5 is folded.
  Grid grid(roof);
  grid.mark_row(4);
  grid.move(at(3, 5), Vec3(0.4, 0.42, roof(0, 0.42)));
  ASSERT_GT(grid.crossings(), 0u);
  EXPECT_GT(grid.refill(0.1), 0);
  EXPECT_EQ(grid.crossings(), 0u);
  std::set<std::array<double, 2>> ridge;  // pieces, from x to x
  const PolyMesh& mesh = grid.quads.mesh;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& a = mesh.positions[face[i]];
      const Vec3& b = mesh.positions[face[(i + 1) % face.size()]];
      if (a.z() == 0 && b.z() == 0) ridge.insert({std::min(a.x(), b.x()), std::max(a.x(), b.x())});
    }
  }
  EXPECT_EQ(ridge.size(), static_cast<std::size_t>(kSize));
  for (const auto& [from, to] : ridge) EXPECT_EQ(to - from, kCell);
}

/// Faces between the vertices of a surface, as a result.
QuadMesh on_vertices(const TriMesh& mesh, const PolyMesh& faces) {
  QuadMesh quads;
  quads.mesh = faces;
  for (Index v = 0; v < faces.vertex_count(); ++v) {
    const Index h = mesh.vertex_out[v];
    quads.provenance.face.push_back(TriMesh::face_of(h));
    quads.provenance.barycentric.push_back({0, 0, 0});
    quads.provenance.barycentric.back()[h % 3] = 1;
    quads.provenance.lines.push_back({kNone, kNone});
  }
  return quads;
}

/// A tetrahedron whose lower corner hangs through a sheet below: without its three lower faces, the
/// upper one would be left with a face on its back.
TEST(Refill, LeavesNothingWithoutVolume) {
  PolyMesh faces;
  faces.positions = {Vec3(0, 0, 0.5), Vec3(1, 0, 0.5), Vec3(0, 1, 0.5), Vec3(0.3, 0.3, 0.1),
                     Vec3(-2, -2, 0), Vec3(3, -2, 0),  Vec3(0, 3, 0)};
  for (const std::array<Index, 3>& f :
       {std::array<Index, 3>{0, 1, 2}, {1, 0, 3}, {2, 1, 3}, {0, 2, 3}, {4, 5, 6}}) {
    faces.add_face(f);
  }
  const TriMesh mesh = support::plain_tri_mesh(faces);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  QuadMesh quads = on_vertices(mesh, faces);
  quads.mesh.positions[3].z() = -0.2;
  ASSERT_FALSE(find_crossing_faces(quads.mesh.positions, triangulate_faces(quads.mesh)).empty());
  refill_crossing_faces(mesh, surface, quads, 10);
  std::set<std::set<Index>> corners;
  for (Index f = 0; f < quads.mesh.face_count(); ++f) {
    const std::span<const Index> face = quads.mesh.face(f);
    EXPECT_TRUE(corners.insert({face.begin(), face.end()}).second) << f;
  }
}

class RefillOfTori : public testing::TestWithParam<std::tuple<Index, Index>> {};

TEST_P(RefillOfTori, KeepsHandles) {
  // Rings around a few faces may be nearly all of a coarse torus, with one outline, and no disk.
  const auto [columns, rows] = GetParam();
  PolyMesh triangles;
  PolyMesh squares;
  for (Index j = 0; j < rows; ++j) {
    for (Index i = 0; i < columns; ++i) {
      const double u = 2 * std::numbers::pi * i / columns;
      const double v = 2 * std::numbers::pi * j / rows;
      squares.positions.emplace_back((2 + std::cos(v)) * std::cos(u),
                                     (2 + std::cos(v)) * std::sin(u), std::sin(v));
      const auto vertex = [&, width = columns, height = rows](Index a, Index b) {
        return (j + b) % height * width + (i + a) % width;
      };
      const std::array<Index, 4> face = {vertex(0, 0), vertex(1, 0), vertex(1, 1), vertex(0, 1)};
      squares.add_face(face);
      triangles.add_face(std::array<Index, 3>{face[0], face[1], face[2]});
      triangles.add_face(std::array<Index, 3>{face[0], face[2], face[3]});
    }
  }
  triangles.positions = squares.positions;
  const TriMesh mesh = support::plain_tri_mesh(triangles);
  const SurfaceDistance surface(mesh.positions, mesh.faces);
  for (Index moved = 0; moved < squares.vertex_count(); ++moved) {
    QuadMesh quads = on_vertices(mesh, squares);
    quads.mesh.positions[moved] = -1.0 * squares.positions[moved];
    refill_crossing_faces(mesh, surface, quads, 10);
    const PolyTopology topology = analyse(quads.mesh);
    EXPECT_TRUE(topology.is_oriented_manifold()) << moved;
    EXPECT_EQ(topology.euler, 0) << moved;
  }
}

INSTANTIATE_TEST_SUITE_P(Sizes, RefillOfTori,
                         testing::Combine(testing::Range(4, 9), testing::Range(4, 9)));

TEST(SurfaceLines, LeadFromPointToPoint) {
  Grid grid(roof);
  grid.mark_row(4);
  const SurfaceLines lines(grid.mesh);
  const auto foot = [&](Index i, Index j) {
    const Index v = at(i, j);
    return SurfacePoint{grid.quads.provenance.face[v], grid.quads.provenance.barycentric[v]};
  };
  const auto length = [&](const SurfacePoint& a, const SurfacePoint& b, double longest) {
    const auto way = lines.way_between(a, b, longest);
    double sum = 0;
    for (std::size_t i = 1; i < way.size(); ++i) {
      sum += (lines.position(way[i]) - lines.position(way[i - 1])).norm();
    }
    return sum;
  };
  EXPECT_DOUBLE_EQ(length(foot(2, 4), foot(5, 4), 0.5), 0.375);
  EXPECT_DOUBLE_EQ(length(foot(5, 4), foot(2, 4), 0.5), 0.375);
  EXPECT_DOUBLE_EQ(length(foot(2, 0), foot(5, 0), 0.5), 0.375);  // the boundary
  EXPECT_TRUE(lines.way_between(foot(2, 4), foot(5, 4), 0.25).empty());
  EXPECT_TRUE(lines.way_between(foot(2, 4), foot(2, 5), 0.5).empty());
  EXPECT_TRUE(lines.places(foot(2, 5)).empty());
  EXPECT_FALSE(lines.places(foot(2, 4)).empty());
}

}  // namespace
}  // namespace strake
