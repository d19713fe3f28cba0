#include "common/geometry/topology/topology.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <map>
#include <random>
#include <set>
#include <vector>

#include "common/core/error.h"
#include "common/geometry/topology/vertex_ring.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

/// An open grid of triangles with one crease along the line x = 1/2.
TriMesh creased_grid() {
  return shapes::imported(shapes::grid(4, 4, [](double x, double) { return x < 0.5 ? x : 1 - x; }))
      .mesh;
}

TEST(Topology, TwinsRunAgainstEachOther) {
  const TriMesh mesh = shapes::imported(shapes::torus(6, 4)).mesh;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    ASSERT_NE(mesh.twin[h], kNone);
    EXPECT_EQ(mesh.twin[mesh.twin[h]], h);
    EXPECT_EQ(mesh.from(mesh.twin[h]), mesh.to(h));
  }
}

TEST(Topology, RotationVisitsTheWholeFanOfEveryVertex) {
  const TriMesh mesh = creased_grid();
  std::vector<Index> corners(mesh.vertex_count(), 0);
  for (const auto& face : mesh.faces) {
    for (const Index v : face) ++corners[v];
  }
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    Index h = mesh.vertex_out[v];
    EXPECT_TRUE(mesh.rotate_cw(h) == kNone || !mesh.is_boundary(h));
    Index visited = 0;
    do {
      EXPECT_EQ(mesh.from(h), v);
      ++visited;
      h = mesh.rotate_ccw(h);
    } while (h != kNone && h != mesh.vertex_out[v]);
    EXPECT_EQ(visited, corners[v]);
  }
}

TEST(Topology, TheFirstWantedHalfedgeAroundAVertexIsFound) {
  const TriMesh mesh = creased_grid();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    std::vector<Index> ring;
    for_each_outgoing(mesh, v, [&](Index h) { ring.push_back(h); });
    for (std::size_t i = 0; i < ring.size(); ++i) {
      std::size_t looked_at = 0;
      const auto is_it = [&](Index h) {
        ++looked_at;
        return h == ring[i];
      };
      EXPECT_EQ(find_outgoing(mesh, v, is_it), ring[i]);
      EXPECT_EQ(looked_at, i + 1);  // none beyond it
      EXPECT_TRUE(any_outgoing(mesh, v, is_it));
    }
    std::size_t looked_at = 0;
    const auto none = [&](Index) {
      ++looked_at;
      return false;
    };
    EXPECT_EQ(find_outgoing(mesh, v, none), kNone);
    EXPECT_EQ(looked_at, ring.size());
    EXPECT_FALSE(any_outgoing(mesh, v, none));
  }
}

TEST(Topology, RefusesEdgesOfThreeFaces) {
  TriMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)};
  mesh.faces = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_THROW(build_topology(mesh), Error);
  mesh.faces = {{0, 1, 2}, {0, 1, 4}};
  EXPECT_THROW(build_topology(mesh), Error);
}

TEST(Wedges, AreTheVerticesWhereThereIsNoFeature) {
  const TriMesh mesh = shapes::imported(shapes::torus(8, 8), {.feature_angle_deg = 180}).mesh;
  ASSERT_EQ(mesh.wedge_count(), mesh.vertex_count());
  for (Index w = 0; w < mesh.wedge_count(); ++w) EXPECT_EQ(mesh.wedge_vertex[w], w);
  EXPECT_EQ(mesh.face_wedges, mesh.faces);
}

TEST(Wedges, ChangeExactlyAcrossBarriersThatSeparate) {
  const TriMesh mesh = creased_grid();
  std::vector<Index> barriers(mesh.vertex_count(), 0);
  std::vector<Index> wedges(mesh.vertex_count(), 0);
  std::vector<Index> on_boundary(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h)) on_boundary[mesh.from(h)] = 1;
    if (mesh.is_feature[h] != 0) ++barriers[mesh.from(h)];
  }
  for (const Index v : mesh.wedge_vertex) ++wedges[v];
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    // n cuts make n pieces of a disk, and n + 1 of a fan.
    EXPECT_EQ(wedges[v], on_boundary[v] != 0 ? barriers[v] + 1 : std::max(barriers[v], 1));
  }
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.is_boundary(h) || barriers[mesh.from(h)] + on_boundary[mesh.from(h)] < 2) continue;
    EXPECT_EQ(mesh.wedge_of(h) == mesh.wedge_of(mesh.rotate_cw(h)), mesh.is_feature[h] == 0);
  }
}

TEST(Census, OfKnownSurfaces) {
  const auto counts = [](const PolyMesh& mesh) { return census(shapes::imported(mesh).mesh); };
  Census cube = counts(shapes::cube());
  EXPECT_EQ(cube.euler_characteristic, 2);
  EXPECT_EQ(cube.genus, 0);
  EXPECT_EQ(cube.boundary_loops, 0);
  Census torus = counts(shapes::torus(5, 4));
  EXPECT_EQ(torus.euler_characteristic, 0);
  EXPECT_EQ(torus.genus, 1);
  Census holed = counts(shapes::filtered(shapes::torus(8, 8), [](Index f) { return f % 20 != 7; }));
  EXPECT_EQ(holed.boundary_loops, 3);
  EXPECT_EQ(holed.genus, 1);
  EXPECT_EQ(holed.euler_characteristic, -3);
  Census two = counts(support::together(shapes::cube(), shapes::torus(5, 4)));
  EXPECT_EQ(two.components, 2);
  EXPECT_EQ(two.genus, 1);
}

TEST(ContentId, TellsMeshesApart) {
  const TriMesh mesh = creased_grid();
  EXPECT_EQ(mesh.id.size(), 32U);
  EXPECT_EQ(content_id(mesh), mesh.id);
  std::set<std::string> ids = {mesh.id};
  TriMesh moved = mesh;
  moved.positions[3].x() += 1e-12;
  ids.insert(content_id(moved));
  TriMesh turned = mesh;
  std::swap(turned.faces[0][0], turned.faces[0][1]);
  ids.insert(content_id(turned));
  TriMesh smooth = mesh;
  smooth.is_feature.assign(smooth.is_feature.size(), 0);
  ids.insert(content_id(smooth));
  TriMesh elsewhere = mesh;
  elsewhere.origin.x() += 1;
  ids.insert(content_id(elsewhere));
  EXPECT_EQ(ids.size(), 5U);
}

TEST(Validate, FindsEveryKindOfDamage) {
  const TriMesh sound = creased_grid();
  ASSERT_NO_THROW(validate(sound));
  const auto inner = [&] {
    for (Index h = 0; h < sound.halfedge_count(); ++h) {
      if (sound.is_feature[h] != 0) return h;
    }
    return kNone;
  }();
  ASSERT_NE(inner, kNone);
  const auto breaks = [&](const char* what, const auto& damage) {
    TriMesh mesh = sound;
    damage(mesh);
    EXPECT_THROW(validate(mesh), Error) << what;
  };
  breaks("a twin lost on one side", [&](TriMesh& m) { m.twin[inner] = kNone; });
  breaks("an edge cut but not separated", [&](TriMesh& m) {
    m.twin[m.twin[inner]] = kNone;
    m.twin[inner] = kNone;
  });
  breaks("a feature on one side", [&](TriMesh& m) { m.is_feature[inner] = 0; });
  breaks("a repeated corner", [](TriMesh& m) { m.faces[0][0] = m.faces[0][1]; });
  breaks("an index out of range", [](TriMesh& m) { m.faces[0][0] = m.vertex_count(); });
  breaks("a vertex nobody uses", [](TriMesh& m) {
    m.positions.push_back(Vec3::Zero());
    m.vertex_out.push_back(0);
    m.is_corner.push_back(0);
    m.source_vertex.push_back(0);
  });
  breaks("a coordinate that is no number", [](TriMesh& m) { m.positions[0].x() = std::nan(""); });
  breaks("a wedge of another vertex", [](TriMesh& m) { m.face_wedges[0][0] = m.wedge_of(1); });
  breaks("flags of another size", [](TriMesh& m) { m.is_corner.pop_back(); });
}

TEST(Topology, ComponentsDoNotDependOnTheOrderOfFaces) {
  TriMesh mesh =
      shapes::imported(
          support::together(shapes::torus(20, 14),
                            support::transformed(shapes::torus(9, 8), Mat3::Identity(), {9, 0, 0})))
          .mesh;
  std::mt19937 random(5);
  std::ranges::shuffle(mesh.faces, random);
  build_topology(mesh);
  const std::vector<Index> component = face_components(mesh);
  std::array<Index, 2> faces = {0, 0};
  Index highest = -1;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    ASSERT_LE(component[f], highest + 1) << "numbered in order of the first face";
    highest = std::max(highest, component[f]);
    ASSERT_LT(component[f], 2);
    ++faces[component[f]];
    for (Index h = 3 * f; h < 3 * f + 3; ++h) {
      EXPECT_EQ(component[f], component[TriMesh::face_of(mesh.twin[h])]);
    }
  }
  EXPECT_EQ(std::max(faces[0], faces[1]), 2 * 20 * 14);
  EXPECT_EQ(std::min(faces[0], faces[1]), 2 * 9 * 8);
}

TEST(Topology, MeasuresComponents) {
  const TriMesh mesh =
      shapes::imported(
          support::together(shapes::cube(),
                            support::transformed(shapes::cube(), 3 * Mat3::Identity(), {5, 0, 0})))
          .mesh;
  const std::vector<double> extents = component_extents(mesh, face_components(mesh));
  ASSERT_EQ(extents.size(), 2u);
  EXPECT_NEAR(std::min(extents[0], extents[1]), std::sqrt(3), 1e-12);
  EXPECT_NEAR(std::max(extents[0], extents[1]), 3 * std::sqrt(3), 1e-12);
}

}  // namespace
}  // namespace strake
