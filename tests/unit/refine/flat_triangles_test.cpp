#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/changes_within.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

/// Above the x axis a face with the side A B, below it two that meet in M on that side, and the
/// triangle A B M without area between them.
PolyMesh half_cut(bool is_quad_above) {
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0}, {3, 0, 0}, {1, 0, 0}, {1, -1, 0}, {2, 2, 0}, {0, 2, 0}};
  constexpr Index kA = 0;
  constexpr Index kB = 1;
  constexpr Index kM = 2;
  if (is_quad_above) {
    mesh.add_face(std::array<Index, 4>{kA, kB, 4, 5});
  } else {
    mesh.add_face(std::array<Index, 3>{kA, kB, 4});
    mesh.add_face(std::array<Index, 3>{kA, 4, 5});
  }
  mesh.add_face(std::array<Index, 3>{kB, kA, kM});
  mesh.add_face(std::array<Index, 3>{kM, kA, 3});
  mesh.add_face(std::array<Index, 3>{kB, kM, 3});
  return mesh;
}

TEST(ChangesWithin, TurnEdgesOfTrianglesWithoutArea) {
  for (const bool is_quad_above : {false, true}) {
    const PolyMesh faces = half_cut(is_quad_above);
    const support::Case c = support::on_triangles(faces, triangulate_faces(faces));
    ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 1e-3);
    QuadMesh quads = c.quads;
    turn_flat_triangles_within(proof, quads);
    EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
    double area = 0;
    for (Index f = 0; f < quads.mesh.face_count(); ++f) {
      const double own = newell_normal(quads.mesh.positions, quads.mesh.face(f)).z() / 2;
      EXPECT_GT(own, 0.1);
      area += own;
    }
    EXPECT_NEAR(area, 6.5, 1e-12);
    EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
    EXPECT_EQ(analyse(quads.mesh).boundary_loops, 1);
  }
}

}  // namespace
}  // namespace strake
