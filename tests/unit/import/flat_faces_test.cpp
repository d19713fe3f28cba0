#include "stages/import/flat_faces.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;

/// A square of side 2 whose left half ends in a vertex in the middle of the edge to the right one;
/// the triangle between has no area, and is of the left half.
PolyMesh halves_with_a_flat_triangle() {
  return shapes::polygons({Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(1, 1, 0), Vec3(0, 0, 0),
                           Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(2, 0, 0), Vec3(2, 2, 0)},
                          {{3, 0, 2},
                           {3, 2, 4},
                           {4, 2, 1},
                           {4, 1, 5},
                           {0, 1, 2},  // left
                           {0, 6, 1},
                           {1, 6, 7}});
}

bool is_right(const TriMesh& mesh, Index f) {
  double x = 0;
  for (const Index v : mesh.faces[f]) x += mesh.positions[v].x() / 3;
  return x + mesh.origin.x() > 1;
}

TEST(FlatFaces, NeighboursKeepTheirLabels) {
  PolyMesh mesh = halves_with_a_flat_triangle();
  mesh.attributes.labels = {{"g", {0, 0, 0, 0, 0, 1, 1}, {"left", "right"}}};
  const ImportResult result = shapes::imported(mesh, shapes::undivided());
  EXPECT_EQ(count(result.report, "repairs.flipped_edges"), 1);
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    EXPECT_EQ(result.mesh.attributes.labels[0].of_face[f], is_right(result.mesh, f) ? 1 : 0) << f;
  }
}

TEST(FlatFaces, NeighboursKeepTheirTexture) {
  PolyMesh mesh = halves_with_a_flat_triangle();
  // u = x on the left, and ten more on the right.
  for (Index f = 0; f < mesh.face_count(); ++f) {
    for (const Index v : mesh.face(f)) {
      const Vec3& p = mesh.positions[v];
      mesh.attributes.texture.push_back({p.x() + (f >= 5 ? 10 : 0), p.y()});
    }
  }
  const TriMesh result = shapes::imported(mesh, shapes::undivided()).mesh;
  for (Index h = 0; h < result.halfedge_count(); ++h) {
    const Vec3 p = result.positions[result.from(h)] + result.origin;
    EXPECT_NEAR(result.attributes.texture[h][0], p.x() + (is_right(result, h / 3) ? 10 : 0), 1e-12);
    EXPECT_NEAR(result.attributes.texture[h][1], p.y(), 1e-12);
  }
}

/// Repair tools close borders that are divided differently by fans, in any order.
TEST(FlatFaces, FansGoInWhateverOrder) {
  constexpr Index kParts = 60;
  for (const bool is_reversed : {false, true}) {
    std::vector<Vec3> positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 2, 0), Vec3(0, 2, 0)};
    std::vector<std::vector<Index>> faces = {{0, 1, 2}, {0, 2, 3}};
    std::vector<Index> side = {0};  // x = 0, from below
    for (Index i = 1; i < kParts; ++i) {
      side.push_back(static_cast<Index>(positions.size()));
      positions.emplace_back(0, 2.0 * i / kParts, 0);
    }
    side.push_back(3);
    const Index left = static_cast<Index>(positions.size());
    positions.emplace_back(-1, 1, 0);
    std::vector<std::vector<Index>> fan;
    for (Index i = 0; i < kParts; ++i) faces.push_back({left, side[i], side[i + 1]});
    for (Index i = 1; i < kParts; ++i) fan.push_back({0, side[i + 1], side[i]});
    if (is_reversed) std::reverse(fan.begin(), fan.end());
    faces.insert(faces.end(), fan.begin(), fan.end());
    const ImportResult result =
        shapes::imported(shapes::polygons(positions, faces), shapes::undivided());
    EXPECT_EQ(count(result.report, "repairs.flipped_edges"), kParts - 1);
    EXPECT_NEAR(shapes::area(result.mesh), 3, 1e-12);
    for (const auto& [a, b, c] : result.mesh.faces) {
      const Vec3& p = result.mesh.positions[a];
      EXPECT_GT((result.mesh.positions[b] - p).cross(result.mesh.positions[c] - p).norm(), 1e-3);
    }
  }
}

}  // namespace
}  // namespace strake
