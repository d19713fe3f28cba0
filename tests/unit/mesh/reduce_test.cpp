#include <gtest/gtest.h>

#include <random>

#include "common/core/poly_mesh.h"
#include "common/geometry/samples/samples.h"
#include "common/geometry/topology/topology.h"
#include "tests/support/import_support.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/mesh/graphs.h"
#include "tests/unit/mesh/line_sets.h"

namespace strake {
namespace {

/// The surface of a slab of unit cubes with two holes through it: genus 2.
TriMesh double_torus() {
  const std::array<std::array<int, 7>, 5> slab = {{{1, 1, 1, 1, 1, 1, 1},
                                                   {1, 0, 1, 1, 1, 0, 1},
                                                   {1, 1, 1, 1, 1, 1, 1},
                                                   {1, 1, 1, 1, 1, 1, 1},
                                                   {1, 1, 1, 1, 1, 1, 1}}};
  const auto solid = [&](int x, int y, int z) {
    return z == 0 && x >= 0 && x < 7 && y >= 0 && y < 5 && slab[y][x] != 0;
  };
  PolyMesh soup;
  const auto vertex = [&](int x, int y, int z) {
    soup.positions.emplace_back(x, y, z);
    return soup.vertex_count() - 1;
  };
  for (int y = 0; y < 5; ++y) {
    for (int x = 0; x < 7; ++x) {
      if (!solid(x, y, 0)) continue;
      for (int axis = 0; axis < 3; ++axis) {
        for (const int side : {0, 1}) {
          std::array<int, 3> step = {0, 0, 0};
          step[axis] = side == 1 ? 1 : -1;
          if (solid(x + step[0], y + step[1], step[2])) continue;
          std::array<Index, 4> quad{};
          for (int k = 0; k < 4; ++k) {
            std::array<int, 3> c = {x, y, 0};
            c[axis] += side;
            c[(axis + 1) % 3] += k == 1 || k == 2;
            c[(axis + 2) % 3] += k >= 2;
            quad[side == 1 ? k : 3 - k] = vertex(c[0], c[1], c[2]);
          }
          soup.add_face(quad);
        }
      }
    }
  }
  return support::import_tri_mesh(soup, 180);
}

struct ClosedSurface {
  const char* name;
  TriMesh mesh;
  Index genus;
};

std::vector<ClosedSurface> closed_surfaces() {
  SampleOptions options;
  options.faces = 500;
  return {{"sphere", support::plain_tri_mesh(make_sample(SampleKind::sphere, options)), 0},
          {"torus", support::plain_tri_mesh(make_sample(SampleKind::torus, options)), 1},
          {"double torus", double_torus(), 2}};
}

Index line_edges(const Overlay& overlay) {
  Index edges = 0;
  for (Index e = 0; e < overlay.graph.dart_count() / 2; ++e) {
    edges += overlay.graph.is_alive(2 * e) && overlay.kind[e] == EdgeKind::line;
  }
  return edges;
}

/// Reduces, and checks that what is left is the whole surface in disks.
void expect_reduction(const ClosedSurface& surface, const LineSet& lines) {
  Overlay overlay = overlay_of(surface.mesh, lines);
  const Index pieces = line_edges(overlay);
  const Index cuts = reduce_to_lines(overlay);
  ASSERT_TRUE(is_consistent(overlay.graph));
  const GraphCounts counts = count(overlay.graph);
  EXPECT_EQ(counts.parts, 1);
  EXPECT_EQ(counts.loose_ends, 0);
  EXPECT_EQ(counts.euler(), 2 - 2 * surface.genus) << "in one part: every cell is a disk";
  EXPECT_EQ(line_edges(overlay), pieces) << "closed lines stay whole";
  EXPECT_EQ(counts.edges - pieces, cuts);
}

TEST(ReduceToLines, KeepsTheSurfaceWithRandomLoops) {
  std::mt19937_64 random(1);
  for (const ClosedSurface& surface : closed_surfaces()) {
    SCOPED_TRACE(surface.name);
    ASSERT_EQ(census(surface.mesh).genus, surface.genus);
    for (int round = 0; round < 12; ++round) {
      LineSet lines;
      for (auto n = 1 + random() % 8; n > 0; --n) add_random_loop(surface.mesh, 40, random, lines);
      expect_reduction(surface, lines);
    }
  }
}

TEST(ReduceToLines, KeepsTheSurfaceWithASingleSmallLoop) {
  std::mt19937_64 random(2);
  for (const ClosedSurface& surface : closed_surfaces()) {
    SCOPED_TRACE(surface.name);
    // Around one vertex: on one side a disk, on the other all the rest.
    const TriMesh& mesh = surface.mesh;
    std::vector<LinePoint> points;
    std::vector<Index> faces;
    const Index first = mesh.vertex_out[mesh.vertex_count() / 2];
    Index h = first;
    do {
      points.push_back({h, 0.4});
      faces.push_back(TriMesh::face_of(h));
      h = mesh.rotate_ccw(h);
    } while (h != first);
    LineSet lines;
    add_line(lines, points, faces);
    expect_reduction(surface, lines);
  }
}

TEST(ReduceToLines, LeavesACutGraphWhereThereIsNoLine) {
  for (const ClosedSurface& surface : closed_surfaces()) {
    SCOPED_TRACE(surface.name);
    Overlay overlay = overlay_of(surface.mesh);
    const Index cuts = reduce_to_lines(overlay);
    const GraphCounts counts = count(overlay.graph);
    EXPECT_EQ(counts.edges, cuts);
    if (surface.genus == 0) {
      EXPECT_EQ(cuts, 0) << "a sphere is one cell without an edge";
      continue;
    }
    ASSERT_TRUE(is_consistent(overlay.graph));
    EXPECT_EQ(counts.cells, 1) << "cut open just enough";
    EXPECT_EQ(counts.parts, 1);
    EXPECT_EQ(counts.loose_ends, 0);
    EXPECT_EQ(counts.euler(), 2 - 2 * surface.genus);
  }
}

TEST(ReduceToLines, PrunesLinesThatEndInACell) {
  SampleOptions options;
  options.faces = 500;
  const TriMesh mesh = support::import_tri_mesh(make_sample(SampleKind::plane, options));
  LineSet lines;
  add_level_lines(
      mesh, [](const Vec3& p) { return p.x() - 0.123; }, LineFamily::minimum, lines);
  add_level_lines(
      mesh, [](const Vec3& p) { return p.y() - 0.257; }, LineFamily::maximum, lines);
  ASSERT_EQ(lines.line_count(), 2);
  Overlay whole = overlay_of(mesh, lines);
  reduce_to_lines(whole);
  // The second line cut short: half of it remains, up to the first line or nothing beyond it.
  LineSet cut;
  for (Index l = 0; l < 2; ++l) {
    const Index first = lines.offsets[l];
    Index last = lines.offsets[l + 1];
    if (l == 1) last -= (last - first) / 5;
    add_line(cut, {lines.points.begin() + first, lines.points.begin() + last},
             {lines.chord_face.begin() + first, lines.chord_face.begin() + last - 1});
  }
  Overlay pruned = overlay_of(mesh, cut);
  reduce_to_lines(pruned);
  EXPECT_EQ(count(whole.graph).cells, 4 + 1) << "four quarters and the outside";
  EXPECT_EQ(count(pruned.graph).cells, 3 + 1) << "a half and two quarters";
  EXPECT_EQ(count(pruned.graph).loose_ends, 0);
}

}  // namespace
}  // namespace strake
