#include "common/geometry/poly_topology/same_topology.h"

#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "common/core/error.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// What is said of a result; "" where it has the topology of what was before.
template <class Surface>
std::string complaint(const Surface& before, const PolyMesh& result) {
  try {
    require_same_topology(before, analyse(result), "it");
  } catch (const AlgorithmError& error) {
    return error.what();
  }
  return "";
}

PolyMesh without_face(PolyMesh mesh) {
  mesh.corners.resize(mesh.offsets[mesh.face_count() - 1]);
  mesh.offsets.pop_back();
  return mesh;
}

TEST(SameTopology, NamesWhatDiffers) {
  const PolyMesh cube = shapes::cube(3, 1);
  const PolyMesh torus = shapes::torus(8, 5, 1, 0.3);
  EXPECT_EQ(complaint(cube, shapes::cube(2, 5)), "");
  EXPECT_NE(complaint(cube, torus).find("Euler characteristic 0 instead of 2"), std::string::npos);
  EXPECT_NE(complaint(cube, support::together(cube, shapes::cube(2, 5)))
                .find("components 2 instead of 1"),
            std::string::npos);
  EXPECT_NE(complaint(cube, without_face(cube)).find("boundary loops 1 instead of 0"),
            std::string::npos);
}

TEST(SameTopology, OfASurfaceOfTrianglesToo) {
  const TriMesh torus = support::import_tri_mesh(shapes::torus(8, 5, 1, 0.3));
  EXPECT_EQ(complaint(torus, shapes::torus(6, 4, 1, 0.2)), "");
  EXPECT_NE(complaint(torus, shapes::cube(3, 1)).find("Euler characteristic 2 instead of 0"),
            std::string::npos);
}

TEST(SameTopology, WantsAnOrientedManifold) {
  PolyMesh cube = shapes::cube(1, 1);
  const PolyMesh sound = cube;
  std::swap(cube.corners[0], cube.corners[2]);
  EXPECT_NE(complaint(sound, cube).find("no oriented manifold"), std::string::npos);
}

}  // namespace
}  // namespace strake
