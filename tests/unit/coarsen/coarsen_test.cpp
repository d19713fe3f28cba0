#include "stages/coarsen/coarsen.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "common/geometry/mesh_measures.h"
#include "common/geometry/surface_distance/surface_distance.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/coarsen/coarse_samples.h"

namespace strake {
namespace {

using coarsen_test::coarsened;
using coarsen_test::parent_vertex;
using coarsen_test::sample;

const std::vector<SampleKind> kAllKinds = {
    SampleKind::plane,         SampleKind::sphere, SampleKind::cylinder,
    SampleKind::open_cylinder, SampleKind::torus,  SampleKind::ellipsoid,
    SampleKind::hyperboloid,   SampleKind::saddle, SampleKind::part};

/// Pairs of vertices of the finest mesh that feature and boundary edges join.
std::set<std::pair<Index, Index>> barriers(const TriMesh& mesh,
                                           const std::vector<Index>& vertex_of_wedge) {
  std::set<std::pair<Index, Index>> edges;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_barrier(h)) continue;
    edges.insert(std::minmax(vertex_of_wedge[mesh.wedge_of(h)],
                             vertex_of_wedge[mesh.wedge_of(TriMesh::next(h))]));
  }
  return edges;
}

TEST(CoarsenMesh, KeepsTheTopologyAndIsSound) {
  for (const SampleKind kind : kAllKinds) {
    const TriMesh mesh = sample(kind, 12000);
    const TriMesh coarse = coarsened(mesh, 900);
    EXPECT_NO_THROW(validate(coarse));
    const Census before = census(mesh);
    const Census after = census(coarse);
    EXPECT_EQ(after.components, before.components);
    EXPECT_EQ(after.boundary_loops, before.boundary_loops);
    EXPECT_EQ(after.genus, before.genus);
    EXPECT_EQ(coarse.parent_id, mesh.id);
    EXPECT_NE(coarse.id, mesh.id);
    EXPECT_EQ(coarse.diagonal, mesh.diagonal);
  }
}

TEST(CoarsenMesh, HasTheVerticesWanted) {
  for (const SampleKind kind : {SampleKind::sphere, SampleKind::torus, SampleKind::ellipsoid}) {
    const TriMesh mesh = sample(kind, 12000);
    for (const Index wanted : {300, 1000, 3000}) {
      EXPECT_EQ(coarsened(mesh, wanted).vertex_count(), wanted);
    }
  }
}

TEST(CoarsenMesh, AsManyVerticesAsThereAreChangeNothing) {
  const TriMesh mesh = sample(SampleKind::part, 9000);
  const TriMesh coarse = coarsened(mesh, 100000);
  EXPECT_EQ(coarse.positions, mesh.positions);
  EXPECT_EQ(coarse.faces, mesh.faces);
  EXPECT_EQ(coarse.face_wedges, mesh.face_wedges);
  for (Index w = 0; w < coarse.wedge_count(); ++w) EXPECT_EQ(coarse.parent_wedge[w], w);
}

// Neither a tetrahedron nor a torus of few vertices can lose one.
TEST(CoarsenMesh, StopsWhereTheTopologyAllowsNoFewer) {
  const TriMesh sphere = coarsened(sample(SampleKind::sphere, 2000), 4);
  EXPECT_GE(sphere.vertex_count(), 4);
  EXPECT_EQ(census(sphere).euler_characteristic, 2);
  const TriMesh torus = coarsened(sample(SampleKind::torus, 2000), 4);
  EXPECT_GE(torus.vertex_count(), 7);
  EXPECT_EQ(census(torus).euler_characteristic, 0);
}

TEST(CoarsenMesh, EachWedgeIsAtThePlaceAndOnTheSideOfItsParent) {
  for (const SampleKind kind : {SampleKind::part, SampleKind::cylinder, SampleKind::saddle}) {
    const TriMesh mesh = sample(kind, 20000);
    const TriMesh coarse = coarsened(mesh, 2500);
    const std::vector<Vec3> fine_normals = wedge_normals(mesh, FaceNormals(mesh));
    const std::vector<Vec3> normals = wedge_normals(coarse, FaceNormals(coarse));
    std::set<Index> parents(coarse.parent_wedge.begin(), coarse.parent_wedge.end());
    EXPECT_EQ(parents.size(), coarse.parent_wedge.size());
    for (Index w = 0; w < coarse.wedge_count(); ++w) {
      EXPECT_EQ(coarse.positions[coarse.wedge_vertex[w]],
                mesh.positions[parent_vertex(mesh, coarse, w)]);
      // Sides of creases differ by 40 degrees and more.
      EXPECT_GT(normals[w].dot(fine_normals[coarse.parent_wedge[w]]),
                std::cos(20 * std::numbers::pi / 180));
    }
  }
}

TEST(CoarsenMesh, FeatureAndBoundaryEdgesAllStay) {
  for (const SampleKind kind : {SampleKind::part, SampleKind::cylinder, SampleKind::hyperboloid}) {
    const TriMesh mesh = sample(kind, 12000);
    const TriMesh coarse = coarsened(mesh, 100);
    std::vector<Index> vertex_of_wedge;
    for (Index w = 0; w < coarse.wedge_count(); ++w) {
      vertex_of_wedge.push_back(parent_vertex(mesh, coarse, w));
    }
    const auto edges = barriers(mesh, mesh.wedge_vertex);
    ASSERT_FALSE(edges.empty());
    EXPECT_EQ(barriers(coarse, vertex_of_wedge), edges);
    EXPECT_EQ(std::ranges::count(coarse.is_corner, 1), std::ranges::count(mesh.is_corner, 1));
    EXPECT_LT(coarse.vertex_count(), mesh.vertex_count() / 2);
  }
}

/// Largest distance of the vertices of a mesh from another one.
double farthest(const TriMesh& mesh, const TriMesh& from) {
  const SurfaceDistance surface(from.positions, from.faces);
  double largest = 0;
  for (const Vec3& p : mesh.positions) largest = std::max(largest, surface.closest(p).distance);
  return largest;
}

// Edges of length h leave a smooth surface by about h^2, and there are as many vertices as 1 / h^2.
TEST(CoarsenMesh, DistanceIsInverseToTheCount) {
  const TriMesh mesh = sample(SampleKind::ellipsoid, 60000);
  std::vector<double> counts;
  std::vector<double> distances;
  for (const Index count : {500, 1000, 2000, 4000}) {
    counts.push_back(count);
    distances.push_back(farthest(mesh, coarsened(mesh, count)));
  }
  EXPECT_NEAR(support::observed_order(counts, distances), -1, 0.2);
}

TEST(CoarsenMesh, NoEdgeIsMuchLongerThanTheOthers) {
  for (const SampleKind kind : {SampleKind::plane, SampleKind::cylinder}) {
    const TriMesh mesh = sample(kind, 20000);
    const Index wanted = 1000;
    const TriMesh coarse = coarsened(mesh, wanted);
    double area = 0;
    for (const double a : wedge_areas(coarse)) area += a;
    double longest = 0;
    for (Index h = 0; h < coarse.halfedge_count(); ++h) {
      longest = std::max(
          longest, (coarse.positions[coarse.to(h)] - coarse.positions[coarse.from(h)]).norm());
    }
    // Edges made by a collapse are at most 2.5 times as long as the root of the area of a vertex.
    EXPECT_LT(longest, 2.6 * std::sqrt(area / wanted));
  }
}

TEST(CoarsenMesh, DoesNotTurnFacesOver) {
  const TriMesh mesh = sample(SampleKind::part, 20000);
  const TriMesh coarse = coarsened(mesh, 2500);
  for (Index h = 0; h < coarse.halfedge_count(); ++h) {
    if (coarse.is_barrier(h)) continue;
    EXPECT_LT(std::abs(support::dihedral_angle(coarse, h)), std::numbers::pi / 2);
  }
}

TEST(CoarsenMesh, IsTheSameForAnyThreadCount) {
  const TriMesh mesh = sample(SampleKind::part, 20000);
  const auto with_threads = [&](std::size_t count) {
    const tbb::global_control control(tbb::global_control::max_allowed_parallelism, count);
    return coarsened(mesh, 2000);
  };
  const TriMesh one = with_threads(1);
  const TriMesh four = with_threads(4);
  EXPECT_EQ(one.id, four.id);
  EXPECT_EQ(one.faces, four.faces);
  EXPECT_EQ(one.parent_wedge, four.parent_wedge);
}

}  // namespace
}  // namespace strake
