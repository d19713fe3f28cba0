#include "stages/refine/inlay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/poly_topology/poly_topology.h"
#include "tests/support/result_cases.h"
#include "tests/unit/refine/inlay_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;

TEST(InlayCutter, PutsTheInputOverCells) {
  const Case c = grid(32, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  const std::set<Index> cells = nine_cells(cutter);
  ASSERT_EQ(cells.size(), 9u);
  const std::optional<Inlay> inlay = cutter.cut(cells);
  ASSERT_TRUE(inlay.has_value());
  EXPECT_EQ(inlay->cells, std::vector<Index>(cells.begin(), cells.end()));
  EXPECT_EQ(inlay->outline.size(), 12u);
  // Of the input over the cells nothing is left out, but along the outline: it is as large, ...
  const std::vector<Vec3> positions = positions_of(*inlay, surfaces);
  double over = 0;
  double on_plane = 0;
  for (const auto& t : inlay->faces) on_plane += area_vector(positions, t).z();
  for (const auto& t : c.mesh.faces) {
    Vec3 middle = Vec3::Zero();
    for (const Index v : t) middle += c.mesh.positions[v] / 3;
    const bool is_over =
        std::abs(middle.x() - 0.5625) < 0.1875 && std::abs(middle.y() - 0.4375) < 0.1875;
    if (is_over) over += area_vector(c.mesh.positions, t).norm();
  }
  EXPECT_NEAR(on_plane, 9.0 / 64, 1e-9);
  EXPECT_NEAR(area(positions, inlay->faces), over, 0.01 * over);
  // ... and each vertex of it inside is there.
  std::set<std::array<double, 2>> places;
  for (std::size_t i = inlay->outline.size(); i < positions.size(); ++i) {
    places.insert({positions[i].x(), positions[i].y()});
  }
  for (int i = 13; i < 24; ++i) {
    for (int j = 9; j < 20; ++j) {
      EXPECT_TRUE(places.contains({i / 32.0, j / 32.0})) << i << " " << j;
    }
  }
}

TEST(InlayCutter, CutsNoneOfTwoDisksOrOfAll) {
  const Case c = grid(32, 8, terrain);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const InlayCutter cutter(surfaces, c.quads);
  EXPECT_FALSE(cutter.cut({3 * 8 + 3, 3 * 8 + 5}).has_value());
  std::set<Index> all;
  for (Index f = 0; f < 64; ++f) all.insert(f);
  EXPECT_FALSE(cutter.cut(all).has_value());  // no vertex of the result would stay
  std::set<Index> ring = {3 * 8 + 4};
  cutter.add_ring(ring);
  ring.erase(3 * 8 + 4);
  const std::optional<Inlay> inlay = cutter.cut(ring);
  ASSERT_TRUE(inlay.has_value());  // with what it encloses
  EXPECT_EQ(inlay->cells.size(), 9u);
}

TEST(InlayCutter, CutsSmallComponentsAsAWhole) {
  const auto below = [](double x, double y) { return terrain(x, y) - 2; };
  const Case c = flat_sheets(3, 2, below);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  for (const std::size_t most : {3, 4}) {
    const InlayCutter cutter(surfaces, c.quads, most);
    const Index cells = c.quads.mesh.face_count();
    std::set<Index> last;
    for (Index f = cells - 4; f < cells; ++f) last.insert(f);
    const std::optional<Inlay> inlay = cutter.cut(last);
    ASSERT_EQ(inlay.has_value(), most == 4);
    if (!inlay) continue;
    EXPECT_EQ(inlay->cells, std::vector<Index>(last.begin(), last.end()));
    EXPECT_TRUE(inlay->outline.empty());
    EXPECT_EQ(inlay->faces.size(), 128u);
    EXPECT_EQ(inlay->points.size(), 81u);
    for (const SurfacePoint& point : inlay->points) {
      const Vec3 p = place_of(c.mesh, point) + c.mesh.origin;
      EXPECT_NEAR(p.z(), below(p.x(), p.y()), 1e-12);
    }
  }
}

/// The result with an inlay in it.
PolyMesh inlaid(const Case& c, const Inlay& inlay) {
  PolyMesh mesh;
  mesh.positions = c.quads.mesh.positions;
  for (Index f = 0; f < c.quads.mesh.face_count(); ++f) {
    if (!std::ranges::binary_search(inlay.cells, f)) mesh.add_face(c.quads.mesh.face(f));
  }
  const Index first = mesh.vertex_count();
  for (const SurfacePoint& p : inlay.points) {
    mesh.positions.push_back(place_of(c.mesh, p) + c.mesh.origin);
  }
  const auto outline = static_cast<Index>(inlay.outline.size());
  for (std::array<Index, 3> t : inlay.faces) {
    for (Index& v : t) v = v < outline ? inlay.outline[v] : first + v - outline;
    mesh.add_face(t);
  }
  return mesh;
}

double flat_area(const PolyMesh& mesh) {
  double sum = 0;
  for (const auto& t : triangulate_faces(mesh).corners) sum += area_vector(mesh.positions, t).z();
  return sum;
}

/// A case of 8 x 8 cells without those that are named, and without the surface under them.
Case with_hole(const Case& whole, const std::set<Index>& cells) {
  return with_holes(whole, 8, cells, cells);
}

/// Puts an inlay over cells into a result. \pre the surface is not much bent
void expect_inlay(const Case& c, const std::set<Index>& cells, Index euler, Index boundaries) {
  SCOPED_TRACE(testing::PrintToString(cells));
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const std::optional<Inlay> inlay = InlayCutter(surfaces, c.quads).cut(cells);
  ASSERT_TRUE(inlay.has_value());
  EXPECT_GT(inlay->points.size(), 4 * cells.size());
  const PolyMesh mesh = inlaid(c, *inlay);
  const PolyTopology topology = analyse(mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, euler);
  EXPECT_EQ(topology.boundary_loops, boundaries);
  EXPECT_NEAR(flat_area(mesh), flat_area(c.quads.mesh), 1e-9);
}

TEST(InlayCutter, GoesAlongTheBoundary) {
  const Case c = grid(32, 8, terrain);
  expect_inlay(c, {0, 1, 8, 9}, 1, 1);           // a corner
  expect_inlay(c, {3, 4, 5, 11, 12, 13}, 1, 1);  // one side
  std::set<Index> across;
  for (Index f = 24; f < 40; ++f) across.insert(f);  // from one side to the other
  expect_inlay(c, across, 1, 1);
}

TEST(InlayCutter, GoesAroundHoles) {
  const Case c = with_hole(grid(32, 8, terrain), {27, 28});
  std::set<Index> beside = {18, 19, 20, 26};  // part of the hole's boundary
  expect_inlay(c, beside, 0, 2);
  std::set<Index> around;  // all of it
  for (Index y = 2; y < 5; ++y) {
    for (Index x = 2; x < 6; ++x) {
      const Index cell = 8 * y + x;
      if (cell < 27 || cell > 28) around.insert(cell < 27 ? cell : cell - 2);
    }
  }
  expect_inlay(c, around, 0, 2);
}

TEST(InlayCutter, GoesInRings) {
  // Around more cells than it has, which are none of its own.
  const Case c = grid(32, 8, terrain);
  std::set<Index> ring;
  for (Index i = 0; i < 8; ++i) ring.insert({i, 56 + i, 8 * i, 8 * i + 7});
  expect_inlay(c, ring, 1, 1);
}

}  // namespace
}  // namespace strake
