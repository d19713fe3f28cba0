#include "common/geometry/face_crossings/shared_edges.h"

#include <gtest/gtest.h>

#include <array>

#include "tests/support/mesh_support.h"

namespace strake {
namespace {

/// A fan of five triangles around a corner at the origin, whose rim comes by (0, 0, 1) at its first
/// vertex and at the fourth, or beside it.
TriMesh open_fan(double beside) {
  PolyMesh mesh;
  mesh.positions = {Vec3(0, 0, 0),      Vec3(0, 0, 1),  Vec3(1, 0, 0), Vec3(1, 1, 0),
                    Vec3(beside, 0, 1), Vec3(-1, 1, 0), Vec3(-1, 0, 0)};
  for (Index v = 1; v < 6; ++v) mesh.add_face(std::array<Index, 3>{0, v, v + 1});
  return support::plain_tri_mesh(mesh);
}

// As where two blocks that stand on a plate touch along an edge: below it ends in one vertex.
TEST(SharedEdges, MayEndInOneVertex) {
  const SharedEdges shared(open_fan(0), 1e-6);
  EXPECT_TRUE(shared.any());
  EXPECT_TRUE(shared.hold(Vec3(0, 0, 0.5)));
  EXPECT_FALSE(shared.hold(Vec3(0.1, 0, 0.5)));
}

TEST(SharedEdges, AreInTheSamePlace) { EXPECT_FALSE(SharedEdges(open_fan(1e-3), 1e-2).any()); }

}  // namespace
}  // namespace strake
