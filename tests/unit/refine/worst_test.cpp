#include "stages/refine/worst.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;
using support::sheets;

constexpr Index kCells = 16;

/// A hill within one cell, or two.
double hill(double x, double y, double at_x, double at_y) {
  return 0.05 * std::exp(-(std::pow(x - at_x, 2) + std::pow(y - at_y, 2)) / (0.02 * 0.02));
}

double waves(double x, double y) { return 0.01 * std::sin(9 * x) * std::cos(7 * y); }

/// Gentle waves with a hill amid a cell.
double with_hill(double x, double y) { return waves(x, y) + hill(x, y, 0.53, 0.47); }

WorstResult improved(const Case& c, double share) {
  SilentObserver observer;
  WorstOptions options;
  options.share = share;
  return bring_worst_nearer(c.mesh, c.quads, options, observer);
}

ErrorMap errors_of(const Case& c, const QuadMesh& quads) {
  return measure_cells(ComparedSurfaces(c.mesh, quads));
}

TEST(Worst, PlacesComeNearerByFewVertices) {
  const Case c = grid(128, kCells, with_hill);
  const ErrorMap before = errors_of(c, c.quads);
  const WorstResult result = improved(c, 0.1);
  const PolyMesh& mesh = result.quads.mesh;
  const ErrorMap after = errors_of(c, result.quads);
  EXPECT_LT(after.largest, 0.6 * before.largest);
  EXPECT_LE(after.rms, before.rms);
  EXPECT_GT(mesh.vertex_count(), c.quads.mesh.vertex_count());
  EXPECT_LE(mesh.vertex_count(), 1.1 * c.quads.mesh.vertex_count());
  // It is measured with fewer samples there.
  EXPECT_NEAR(result.report.number("refine.largest_before").value(), before.largest,
              0.2 * before.largest);
  EXPECT_NEAR(result.report.number("refine.largest").value(), after.largest, 0.2 * before.largest);
  EXPECT_EQ(result.report.number("refine.added_vertices"),
            mesh.vertex_count() - c.quads.mesh.vertex_count());
  const PolyTopology topology = analyse(mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, 1);
  // What is far from the hill is as it was.
  for (const Vec3& p : c.quads.mesh.positions) {
    if (std::hypot(p.x() - 0.53, p.y() - 0.47) < 0.3) continue;
    EXPECT_EQ(std::ranges::count(mesh.positions, p), 1);
  }
}

/// The fewer vertices there may be, the less near it comes.
TEST(Worst, PlacesComeAsNearAsVerticesAllow) {
  const Case c = grid(128, kCells, with_hill);
  double last = errors_of(c, c.quads).largest;
  const double first = last;
  for (const double share : {0.0, 0.02, 0.05, 0.1, 0.3}) {
    const WorstResult result = improved(c, share);
    EXPECT_LE(result.quads.mesh.vertex_count(), (1 + share) * c.quads.mesh.vertex_count());
    const double largest = errors_of(c, result.quads).largest;
    EXPECT_LE(largest, last) << share;
    last = largest;
    EXPECT_EQ(largest == first, share == 0) << share;
  }
  EXPECT_LT(last, 0.4 * first);
}

/// Hills in every fourth cell would take more vertices than there may be.
TEST(Worst, PlacesStayWhereThereAreMany) {
  const Case c = grid(128, kCells, [](double x, double y) {
    const double cell = 2.0 / kCells;
    return hill(x, y, (std::floor(x / cell) + 0.25) * cell, (std::floor(y / cell) + 0.25) * cell);
  });
  const WorstResult result = improved(c, 0.1);
  EXPECT_EQ(result.quads.mesh.corners, c.quads.mesh.corners);
  EXPECT_EQ(result.quads.mesh.positions, c.quads.mesh.positions);
  EXPECT_EQ(result.report.number("refine.largest"), result.report.number("refine.largest_before"));
}

/// A surface that is as it should be, but for rounding.
TEST(Worst, PlacesStayWhereTheResultIsExact) {
  const Case c = grid(32, kCells, [](double x, double) { return x < 0.5 ? x : 1 - x; });
  const WorstResult result = improved(c, 0.5);
  EXPECT_EQ(result.quads.mesh.corners, c.quads.mesh.corners);
  EXPECT_EQ(result.quads.mesh.positions, c.quads.mesh.positions);
}

/// A sheet close above the hill, whose cells are coarser than the gap.
TEST(Worst, PlacesDoNotComeNearerThroughAnotherSheet) {
  const Case c =
      sheets(128, kCells, {with_hill, [](double x, double y) { return with_hill(x, y) + 0.004; }});
  CrossingPlaces crossing(c.mesh);
  ASSERT_TRUE(crossing.of(c.quads.mesh).empty());
  const WorstResult result = improved(c, 0.1);
  EXPECT_TRUE(crossing.of(result.quads.mesh).empty());
  EXPECT_LT(errors_of(c, result.quads).largest, 0.8 * errors_of(c, c.quads).largest);
}

}  // namespace
}  // namespace strake
