#include "common/geometry/poly_topology/poly_topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <random>

#include "common/core/error.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// Two tetrahedra (outward) with `shared` common vertices.
PolyMesh two_tetrahedra(Index shared) {
  PolyMesh mesh;
  for (Index v = 0; v < 8 - shared; ++v) mesh.positions.emplace_back(v, v * v, v * v * v);
  const auto add = [&](const std::array<Index, 4>& v) {
    mesh.add_face(std::array{v[0], v[2], v[1]});
    mesh.add_face(std::array{v[0], v[1], v[3]});
    mesh.add_face(std::array{v[1], v[2], v[3]});
    mesh.add_face(std::array{v[2], v[0], v[3]});
  };
  add({0, 1, 2, 3});
  std::array<Index, 4> second = {};
  std::iota(second.begin(), second.end(), 4 - shared);
  add(second);
  return mesh;
}

void turn_face(PolyMesh& mesh, Index f) {
  std::reverse(mesh.corners.begin() + mesh.offsets[f], mesh.corners.begin() + mesh.offsets[f + 1]);
}

TEST(PolyTopology, CubeIsASphere) {
  const PolyTopology cube = analyse(shapes::cube(3, 1));
  EXPECT_TRUE(cube.is_oriented_manifold()) << cube.defects();
  EXPECT_EQ(cube.euler, 2);
  EXPECT_EQ(cube.genus, 0);
  EXPECT_EQ(cube.components, 1);
  EXPECT_EQ(cube.boundary_loops, 0);
  EXPECT_EQ(cube.quads, cube.faces);
  EXPECT_EQ(2 * cube.edges, 4 * cube.faces);  // every edge has two sides
}

TEST(PolyTopology, TorusHasOneHandle) {
  const PolyTopology torus = analyse(shapes::torus(8, 5, 1, 0.3));
  EXPECT_TRUE(torus.is_oriented_manifold()) << torus.defects();
  EXPECT_EQ(torus.euler, 0);
  EXPECT_EQ(torus.genus, 1);
}

TEST(PolyTopology, ComponentsAndTheirGenusAddUp) {
  const PolyMesh tori = support::together(shapes::torus(6, 4, 1, 0.2), shapes::torus(5, 7, 3, 0.2));
  const PolyTopology all = analyse(support::together(tori, shapes::cube(1, 9)));
  EXPECT_EQ(all.components, 3);
  EXPECT_EQ(all.genus, 2);
  EXPECT_EQ(all.euler, 2);
}

TEST(PolyTopology, OpenSurfacesHaveLoops) {
  const PolyTopology disk = analyse(shapes::square(4, 0));
  EXPECT_EQ(disk.boundary_loops, 1);
  EXPECT_EQ(disk.boundary_edges, 16);
  EXPECT_EQ(disk.euler, 1);
  EXPECT_EQ(disk.genus, 0);
  const PolyTopology tube = analyse(shapes::grid(5, 2, true, false, [](double s, double t) {
    return Vec3(std::cos(6 * s), std::sin(6 * s), t);
  }));
  EXPECT_EQ(tube.boundary_loops, 2);
  EXPECT_EQ(tube.euler, 0);
  EXPECT_EQ(tube.genus, 0);
}

TEST(PolyTopology, HolesThatTouchAtAVertexAreTwoLoopsAroundTwoFans) {
  PolyMesh mesh;
  const PolyMesh whole = shapes::square(4, 0);
  for (Index f = 0; f < whole.face_count(); ++f) {
    if (f != 5 && f != 10) mesh.add_face(whole.face(f));  // diagonal neighbours inside
  }
  mesh.positions = whole.positions;
  const PolyTopology topology = analyse(mesh);
  EXPECT_EQ(topology.nonmanifold_vertices.count, 1);
  EXPECT_EQ(topology.nonmanifold_vertices.first, 2 * 5 + 2);  // the middle of the grid
  // Around each of the two fans one hole's edges run into the other's: outside, and one run inside.
  EXPECT_EQ(topology.boundary_loops, 2);
  EXPECT_FALSE(topology.genus.has_value());
}

TEST(PolyTopology, MoebiusBandCannotBeOriented) {
  const PolyTopology band = analyse(shapes::moebius_band(9));
  EXPECT_EQ(band.misoriented_edges.count, 1);
  EXPECT_FALSE(band.is_orientable);
  EXPECT_FALSE(band.is_oriented_manifold());
  EXPECT_EQ(band.boundary_loops, 1);
  EXPECT_EQ(band.euler, 0);
  EXPECT_FALSE(band.genus.has_value());
}

TEST(PolyTopology, TurnedFaceIsMisorientedButOrientable) {
  PolyMesh mesh = shapes::cube(2, 1);
  turn_face(mesh, 7);
  const PolyTopology topology = analyse(mesh);
  EXPECT_EQ(topology.misoriented_edges.count, 4);
  EXPECT_TRUE(topology.is_orientable);
  EXPECT_FALSE(topology.is_oriented_manifold());
  const std::span<const Index> face = mesh.face(7);
  for (const Index v : topology.misoriented_edges.vertices) {
    EXPECT_NE(std::find(face.begin(), face.end(), v), face.end());
  }
  EXPECT_NE(topology.defects().find("run the same way"), std::string::npos);
}

TEST(PolyTopology, SharedVertexHasTwoFans) {
  const PolyTopology topology = analyse(two_tetrahedra(1));
  EXPECT_EQ(topology.nonmanifold_vertices.count, 1);
  EXPECT_EQ(topology.nonmanifold_vertices.first, 3);
  EXPECT_EQ(topology.nonmanifold_edges.count, 0);
  EXPECT_EQ(topology.components, 2);  // connected over edges only
  EXPECT_FALSE(topology.is_oriented_manifold());
}

TEST(PolyTopology, SharedEdgeHasFourFaces) {
  const PolyTopology topology = analyse(two_tetrahedra(2));
  EXPECT_EQ(topology.nonmanifold_edges.count, 1);
  EXPECT_EQ(topology.nonmanifold_edges.vertices, (std::array<Index, 2>{2, 3}));
  EXPECT_EQ(topology.nonmanifold_vertices.count, 2);
  EXPECT_EQ(topology.components, 1);
}

TEST(PolyTopology, FacesWithBadCornersAreFound) {
  PolyMesh mesh = shapes::square(3, 0);
  const Index repeated = mesh.face_count();
  mesh.add_face(std::array<Index, 4>{0, 1, 0, 2});
  const Index small = mesh.face_count();
  mesh.add_face(std::array<Index, 2>{3, 4});
  const PolyTopology topology = analyse(mesh);
  EXPECT_EQ(topology.repeated_corners.count, 1);
  EXPECT_EQ(topology.repeated_corners.first, repeated);
  EXPECT_EQ(topology.small_faces.count, 1);
  EXPECT_EQ(topology.small_faces.first, small);
  EXPECT_FALSE(topology.is_oriented_manifold());
}

TEST(PolyTopology, CornerOutOfRangeIsRefusedByName) {
  PolyMesh mesh = shapes::square(1, 0);
  mesh.add_face(std::array<Index, 3>{0, 1, 99});
  try {
    analyse(mesh);
    FAIL() << "accepted vertex 99 of 4";
  } catch (const PreconditionError& error) {
    EXPECT_NE(std::string(error.what()).find("face 1"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("99"), std::string::npos) << error.what();
  }
}

TEST(PolyTopology, CountsSidesAndUnusedVertices) {
  PolyMesh mesh;
  mesh.positions.resize(20, Vec3::Zero());
  mesh.add_face(std::array<Index, 3>{0, 1, 2});
  mesh.add_face(std::array<Index, 5>{3, 4, 5, 6, 7});
  mesh.add_face(std::array<Index, 7>{8, 9, 10, 11, 12, 13, 14});
  const PolyTopology topology = analyse(mesh);
  EXPECT_EQ(topology.triangles, 1);
  EXPECT_EQ(topology.quads, 0);
  EXPECT_EQ(topology.pentagons, 1);
  EXPECT_EQ(topology.larger_faces, 1);
  EXPECT_EQ(topology.most_sides, 7);
  EXPECT_EQ(topology.unused_vertices, 5);
  EXPECT_EQ(topology.used_vertices, 15);
}

TEST(PolyTopology, DoesNotDependOnNumbering) {
  PolyMesh mesh = support::together(shapes::torus(7, 5, 1, 0.3), shapes::square(4, 2));
  turn_face(mesh, 3);
  std::mt19937 random(5);
  std::vector<Index> rename(mesh.positions.size());
  std::iota(rename.begin(), rename.end(), 0);
  std::shuffle(rename.begin(), rename.end(), random);
  std::vector<Index> order(static_cast<std::size_t>(mesh.face_count()));
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), random);
  PolyMesh other;
  other.positions.resize(mesh.positions.size());
  for (const Index f : order) {
    std::vector<Index> face;
    for (const Index v : mesh.face(f)) face.push_back(rename[v]);
    std::rotate(face.begin(), face.begin() + f % 4, face.end());
    other.add_face(face);
  }
  const PolyTopology a = analyse(mesh);
  const PolyTopology b = analyse(other);
  EXPECT_EQ(a.edges, b.edges);
  EXPECT_EQ(a.components, b.components);
  EXPECT_EQ(a.boundary_loops, b.boundary_loops);
  EXPECT_EQ(a.euler, b.euler);
  EXPECT_EQ(a.misoriented_edges.count, b.misoriented_edges.count);
  EXPECT_EQ(a.is_orientable, b.is_orientable);
}

}  // namespace
}  // namespace strake
