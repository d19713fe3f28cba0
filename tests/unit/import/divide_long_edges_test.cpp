#include "stages/import/divide_long_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "common/geometry/density.h"
#include "common/geometry/mesh_measures.h"
#include "tests/support/attributed.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;
using shapes::imported;

ImportResult divided(const PolyMesh& mesh, double longest_percent) {
  ImportOptions options;
  options.longest_edge = percent(longest_percent);
  return imported(mesh, options);
}

double longest_edge(const TriMesh& mesh) {
  double longest = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    longest = std::max(longest, (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm());
  }
  return longest;
}

double feature_length(const TriMesh& mesh) {
  double length = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_barrier(h) || mesh.edge_of(h) != h) continue;
    length += (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
  }
  return length;
}

double area(const TriMesh& mesh) {
  const std::vector<double> areas = wedge_areas(mesh);
  return std::accumulate(areas.begin(), areas.end(), 0.0);
}

/// A cone that is a fan of triangles around its tip, closed by another one around the middle of its
/// base, as programs for modelling make it.
PolyMesh fan_cone(int sides) {
  std::vector<Vec3> positions = {Vec3(0, 0, 2), Vec3(0, 0, 0)};
  std::vector<std::vector<Index>> faces;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * std::numbers::pi * i / sides;
    positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    const Index here = 2 + i;
    const Index next = 2 + (i + 1) % sides;
    faces.push_back({0, here, next});
    faces.push_back({1, next, here});
  }
  return shapes::polygons(positions, faces);
}

TEST(DivideLongEdges, LeavesTheSurfaceAsItIs) {
  for (const PolyMesh& input : {fan_cone(24), shapes::cube(), support::seamed_tube(7, 2)}) {
    const TriMesh before = imported(input).mesh;
    for (const double percent : {40.0, 11.0, 3.0}) {
      const TriMesh after = divided(input, percent).mesh;
      EXPECT_LE(longest_edge(after), percent / 100 * after.diagonal);
      EXPECT_NEAR(area(after), area(before), 1e-9);
      EXPECT_NEAR(shapes::volume(after), shapes::volume(before), 1e-9);
      EXPECT_NEAR(feature_length(after), feature_length(before), 1e-9);
      EXPECT_EQ(std::ranges::count(after.is_corner, 1), std::ranges::count(before.is_corner, 1));
      EXPECT_EQ(census(after).euler_characteristic, census(before).euler_characteristic);
      EXPECT_EQ(census(after).boundary_loops, census(before).boundary_loops);
    }
  }
}

/// Two blocks in a row on a plane, with an edge from each corner to the nearest one of the other.
PolyMesh blocks_in_a_row() {
  const std::vector<double> x = {-1, 0, 1, 1.5, 2.5, 3.5};
  const std::vector<double> y = {-1, 0, 1, 2};
  std::vector<Vec3> positions;
  std::vector<std::vector<Index>> faces;
  const auto columns = static_cast<Index>(x.size());
  for (const double z : {0.0, 1.0}) {
    for (const double v : y) {
      for (const double u : x) positions.emplace_back(u, v, z);
    }
  }
  const auto level = static_cast<Index>(x.size() * y.size());
  const auto add = [&](Index a, Index b, Index c, Index d) {
    faces.push_back({a, b, c});
    faces.push_back({a, c, d});
  };
  for (Index j = 0; j + 1 < static_cast<Index>(y.size()); ++j) {
    for (Index i = 0; i + 1 < columns; ++i) {
      const Index a = j * columns + i;
      const std::array<Index, 4> around = {a, a + 1, a + columns + 1, a + columns};
      const bool is_block = j == 1 && (i == 1 || i == 3);
      const Index up = is_block ? level : 0;
      add(around[0] + up, around[1] + up, around[2] + up, around[3] + up);
      for (std::size_t k = 0; is_block && k < 4; ++k) {
        const Index from = around[k];
        const Index to = around[(k + 1) % 4];
        add(from, to, to + level, from + level);
      }
    }
  }
  return shapes::polygons(positions, faces);
}

TEST(DivideLongEdges, LeavesNoEdgeBetweenFeaturesInARow) {
  const TriMesh undivided = divided(blocks_in_a_row(), 100).mesh;
  const TriMesh mesh = divided(blocks_in_a_row(), 60).mesh;
  std::vector<std::pair<double, double>> added;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 p = mesh.positions[v] + mesh.origin;
    if (mesh.source_vertex[v] == kNone) added.emplace_back(p.x(), p.y());
  }
  std::ranges::sort(added);
  EXPECT_EQ(added, (std::vector<std::pair<double, double>>{{1.25, 0}, {1.25, 1}}));
  EXPECT_EQ(mesh.vertex_count(), undivided.vertex_count() + 2);
}

TEST(DivideLongEdges, ChangesNothingWhereNoneIsLong) {
  const PolyMesh torus = shapes::torus(60, 30);
  const ImportResult result = divided(torus, 10);
  EXPECT_EQ(result.mesh.id, imported(torus).mesh.id);
  EXPECT_EQ(count(result.report, "division.inserted_vertices"), 0);
}

TEST(DivideLongEdges, CarriesColoursTextureAndLabels) {
  const PolyMesh cube = support::labelled_cube(2);
  const TriMesh mesh = divided(cube, 7).mesh;
  ASSERT_GT(mesh.vertex_count(), 10 * cube.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Colour wanted = support::linear_colour(mesh.positions[v] + mesh.origin);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_NEAR(mesh.attributes.colour[v][i], wanted[i], 1e-12);
    }
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const auto& [a, b, c] = mesh.faces[f];
    const Vec3 normal = (mesh.positions[b] - mesh.positions[a])
                            .cross(mesh.positions[c] - mesh.positions[a])
                            .normalized();
    EXPECT_EQ(mesh.attributes.labels[0].of_face[f], support::side_of(normal));
    EXPECT_EQ(mesh.attributes.labels[0].of_face[f],
              cube.attributes.labels[0].of_face[mesh.source_face[f]]);
  }
  // The share of the turn is no linear function of the place, but the height is.
  const TriMesh tube = divided(support::seamed_tube(7, 2), 7).mesh;
  for (Index h = 0; h < tube.halfedge_count(); ++h) {
    EXPECT_NEAR(tube.attributes.texture[h][1], (tube.positions[tube.from(h)] + tube.origin).z(),
                1e-12);
  }
}

/// Between vertices of the file a density is that around it, however many were inserted there.
TEST(DivideLongEdges, LeavesADensityBetweenItsValues) {
  const PolyMesh square = shapes::grid(1, 1, [](double, double) { return 0.0; });
  const TriMesh mesh = divided(square, 3).mesh;
  const std::vector<double> at_wedge = density_at_wedges(mesh, {"", {1, 5, 5, 1}});
  for (Index w = 0; w < mesh.wedge_count(); ++w) {
    const Vec3& p = mesh.positions[mesh.wedge_vertex[w]];
    EXPECT_GE(at_wedge[w], 1);
    EXPECT_LE(at_wedge[w], 5);
    if (p.x() < 0.02 && p.y() < 0.4) {
      EXPECT_LT(at_wedge[w], 3);
    }
  }
}

TEST(DivideLongEdges, StopsBeforeThereAreTooManyVertices) {
  TriMesh mesh = imported(fan_cone(24)).mesh;
  const double before = longest_edge(mesh);
  const Index most = 400;
  const Index inserted = import::divide_long_edges(mesh, 1e-3 * mesh.diagonal, most);
  build_wedges(mesh);
  validate(mesh);
  EXPECT_GT(inserted, 0);
  EXPECT_LE(mesh.vertex_count(), most);
  EXPECT_LT(longest_edge(mesh), 0.51 * before);  // the long ones came first
}

/// A spike of needles: pieces of them would be needles, too.
TEST(DivideLongEdges, LeavesNeedlesAsTheyAre) {
  PolyMesh spike = fan_cone(64);
  spike.positions[0].z() = 1e4;
  const ImportResult result = divided(spike, 5);
  EXPECT_EQ(count(result.report, "division.inserted_vertices"), 0);
}

}  // namespace
}  // namespace strake
