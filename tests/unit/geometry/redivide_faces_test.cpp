#include "common/geometry/patch_fill/redivide_faces.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <random>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using Face = std::vector<Index>;

constexpr auto kAny = [](Index, Index) { return true; };

PolyMesh mesh_of(const std::vector<Vec3>& positions, const std::vector<Face>& faces) {
  PolyMesh mesh;
  mesh.positions = positions;
  for (const Face& face : faces) mesh.add_face(face);
  return mesh;
}

/// Two triangles with a row of slanted quads between them: squares, drawn otherwise.
PolyMesh slanted_row(Index quads) {
  PolyMesh mesh;
  const Index columns = quads + 2;
  for (Index i = 0; i < columns; ++i) mesh.positions.emplace_back(i, 0, 0);
  for (Index i = 0; i < columns; ++i) mesh.positions.emplace_back(i, 1, 0);
  const auto top = [&](Index i) { return columns + i; };
  mesh.add_face(Face{0, 1, top(0)});
  for (Index i = 1; i <= quads; ++i) mesh.add_face(Face{i, i + 1, top(i), top(i - 1)});
  mesh.add_face(Face{columns - 1, top(columns - 1), top(columns - 2)});
  return mesh;
}

PolyMesh redivided(const PolyMesh& mesh, std::size_t expected_changes) {
  const std::vector<Redivision> changes = find_redivisions(mesh, kAny, {});
  EXPECT_EQ(changes.size(), expected_changes);
  std::vector<Index> change_of_face;
  PolyMesh result = redivide_faces(mesh, changes, change_of_face);
  EXPECT_EQ(change_of_face.size(), static_cast<std::size_t>(result.face_count()));
  return result;
}

Index odd_faces(const PolyMesh& mesh) {
  Index count = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) count += mesh.face(f).size() % 2 != 0 ? 1 : 0;
  return count;
}

TEST(RedivideFaces, SlantedRowsBecomeSquares) {
  for (const Index quads : {0, 1, 2, 3}) {
    const PolyMesh result = redivided(slanted_row(quads), 1);
    ASSERT_EQ(result.face_count(), quads + 1);
    for (Index f = 0; f < result.face_count(); ++f) {
      ASSERT_EQ(result.face(f).size(), 4U);
      // Squares of area 1: no other quads of these vertices have right angles.
      EXPECT_NEAR(newell_normal(result.positions, result.face(f)).z(), 2, 1e-12);
      for (std::size_t i = 0; i < 4; ++i) {
        const Vec3& p = result.positions[result.face(f)[i]];
        const Vec3& q = result.positions[result.face(f)[(i + 1) % 4]];
        EXPECT_NEAR((q - p).norm(), 1, 1e-12);
      }
    }
  }
  EXPECT_EQ(odd_faces(redivided(slanted_row(4), 0)), 2);  // farther apart than is looked
}

TEST(RedivideFaces, ATriangleAndAPentagonBecomeTwoQuads) {
  const PolyMesh mesh = mesh_of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}, {0, 1, 0}},
                                {{0, 1, 5}, {1, 2, 3, 4, 5}});
  const PolyMesh result = redivided(mesh, 1);
  EXPECT_EQ(result.face_count(), 2);
  EXPECT_EQ(odd_faces(result), 0);
  EXPECT_NEAR(support::total_area(result), 2, 1e-12);
}

TEST(RedivideFaces, LeavesWhatItMayNotChange) {
  const PolyMesh mesh = slanted_row(1);
  const auto but_one = [](Index a, Index b) { return std::minmax(a, b) != std::minmax(1, 3); };
  EXPECT_TRUE(find_redivisions(mesh, but_one, {}).empty());
  const std::vector<Redivision> changes = find_redivisions(mesh, kAny, {});
  ASSERT_EQ(changes.size(), 1U);
  EXPECT_EQ(changes[0].outline, (Face{0, 1, 2, 5, 4, 3}));
  EXPECT_TRUE(find_redivisions(mesh, kAny, {changes[0].outline}).empty());
}

TEST(RedivideFaces, DoesNotFlattenRidges) {
  PolyMesh mesh = slanted_row(0);
  mesh.positions[0].z() = -0.2;
  mesh.positions[3].z() = -0.2;
  EXPECT_EQ(find_redivisions(mesh, kAny, {}).size(), 1U);
  mesh.positions[0].z() = -2;
  mesh.positions[3].z() = -2;
  EXPECT_TRUE(find_redivisions(mesh, kAny, {}).empty());
}

/// Two triangles that make a good quad, and a third one folded under them: without the edge
/// between the first two their common corner would have two edges.
TEST(RedivideFaces, LeavesNoVertexWithTwoEdges) {
  const std::vector<Vec3> positions = {{-1, 0, 0}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0.1}};
  EXPECT_EQ(find_redivisions(mesh_of(positions, {{0, 1, 3}, {1, 2, 3}}), kAny, {}).size(), 1U);
  const PolyMesh closed = mesh_of(positions, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  EXPECT_TRUE(find_redivisions(closed, kAny, {}).empty());
}

/// A jittered grid, each square cut along one of its diagonals or not at all, at random.
TEST(RedivideFaces, KeepsTheSurfaceAndItsTopology) {
  constexpr Index n = 20;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> jitter(-0.2, 0.2);
  PolyMesh mesh;
  for (Index y = 0; y <= n; ++y) {
    for (Index x = 0; x <= n; ++x) {
      const bool inside = x % n != 0 && y % n != 0;
      mesh.positions.emplace_back(x + (inside ? jitter(random) : 0),
                                  y + (inside ? jitter(random) : 0), 0);
    }
  }
  for (Index y = 0; y < n; ++y) {
    for (Index x = 0; x < n; ++x) {
      const Index a = y * (n + 1) + x;
      const Face quad = {a, a + 1, a + n + 2, a + n + 1};
      const auto cut = random() % 4;
      if (cut > 1) {
        mesh.add_face(quad);
        continue;
      }
      mesh.add_face(Face{quad[cut], quad[cut + 1], quad[cut + 2]});
      mesh.add_face(Face{quad[cut + 2], quad[(cut + 3) % 4], quad[cut]});
    }
  }
  const Index odd = odd_faces(mesh);
  const std::vector<Redivision> changes = find_redivisions(mesh, kAny, {});
  ASSERT_GT(changes.size(), 20U);
  std::vector<Index> change_of_face;
  const PolyMesh result = redivide_faces(mesh, changes, change_of_face);
  EXPECT_EQ(odd_faces(result), odd - 2 * static_cast<Index>(changes.size()));
  const PolyTopology topology = analyse(result);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, analyse(mesh).euler);
  EXPECT_NEAR(support::total_area(result), n * n, 1e-9);
  for (Index f = 0; f < result.face_count(); ++f) {
    EXPECT_GT(newell_normal(result.positions, result.face(f)).z(), 0);
    if (change_of_face[f] == kNone) continue;
    EXPECT_EQ(result.face(f).size(), 4U);
    EXPECT_FALSE(is_concave_face(result.positions, result.face(f)));
    for (const Index v : result.face(f)) {
      EXPECT_NE(std::ranges::find(changes[change_of_face[f]].outline, v),
                changes[change_of_face[f]].outline.end());
    }
  }
  // The best comes first, and no vertex is in two of them.
  std::vector<char> seen(mesh.positions.size(), 0);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    EXPECT_GE(changes[i].price, changes[i > 0 ? i - 1 : 0].price);
    for (const Index v : changes[i].outline) EXPECT_EQ(std::exchange(seen[v], 1), 0);
  }
}

}  // namespace
}  // namespace strake
