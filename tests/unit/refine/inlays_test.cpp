#include "stages/refine/inlays.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "common/geometry/cell_error/tolerance_check.h"
#include "common/geometry/face_crossings/crossing_places.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "stages/refine/refine.h"
#include "stages/refine/uncross.h"
#include "tests/support/result_cases.h"
#include "tests/unit/refine/inlay_cases.h"

namespace strake {
namespace {

using support::Case;
using support::grid;
using support::sheets;

/// Terrain with a needle amid a cell of 8 x 8.
Case needle() {
  return grid(32, 8, [](double x, double y) {
    return 0.2 * terrain(x, y) + (std::hypot(x - 0.59375, y - 0.46875) < 0.01 ? 0.4 : 0.0);
  });
}

/// A result with inlays where it was beyond a tolerance, which it is not any more.
QuadMesh mended(const Case& c, double tolerance) {
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), tolerance);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  EXPECT_FALSE(excess.empty());
  EXPECT_TRUE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), tolerance).empty());
  return quads;
}

TEST(Inlays, BringWhatIsBeyondWithinTheTolerance) {
  const Case c = needle();
  const QuadMesh quads = mended(c, 0.004);
  const PolyTopology topology = analyse(quads.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold());
  EXPECT_EQ(topology.euler, 1);
  EXPECT_LT(quads.mesh.vertex_count(), c.mesh.vertex_count());
  for (Index v = 0; v < quads.mesh.vertex_count(); ++v) {
    const Vec3 foot = place_of(c.mesh, {quads.provenance.face[v], quads.provenance.barycentric[v]});
    EXPECT_LT((foot - quads.mesh.positions[v]).norm(), 1e-12);
  }
}

TEST(Inlays, AreNotThinnedOutThroughWhatIsNear) {
  // A valley with a pit, and a sheet closely above it: longer edges than those of cells would cut
  // across the valley through that sheet.
  const auto valley = [](double x) { return 0.5 * (x - 0.5) * (x - 0.5); };
  const auto below = [&](double x, double y) {
    return valley(x) - (std::hypot(x - 0.46875, y - 0.46875) < 0.005 ? 0.1 : 0.0);
  };
  const auto above = [&](double x, double) { return valley(x) + 0.0003; };
  const Case c = sheets(64, 16, {below, above});
  constexpr double kTolerance = 0.01;
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), kTolerance);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  ASSERT_FALSE(excess.empty());
  ASSERT_TRUE(crossing.faces_of(quads.mesh).empty());
  ASSERT_TRUE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), kTolerance).empty());
}

/// One round of dividing does not reach a needle.
TEST(Inlays, DoWhatDividingLeaves) {
  const Case c = needle();
  RefineOptions options;
  options.tolerance = Length{0.004, false};
  options.rounds = 1;
  SilentObserver observer;
  const RefineResult result = refine_cells(c.mesh, c.quads, options, observer);
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result.quads), 0.004).empty());
  const auto& entries = result.report.entries();
  const auto beyond = std::ranges::find(entries, "refine.places_beyond",
                                        [](const auto& entry) { return entry.first; });
  ASSERT_NE(beyond, entries.end());
  EXPECT_EQ(std::get<std::int64_t>(beyond->second), 0);
}

TEST(Inlays, LeaveAResultThatTheyCannotMend) {
  const Case c = grid(32, 1, [](double x, double) { return x * (1 - x); });  // one cell is all
  CrossingPlaces crossing(c.mesh);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.01);
  QuadMesh quads = c.quads;
  const auto excess = proof.check(ComparedSurfaces(proof.input(), quads));
  ASSERT_FALSE(excess.empty());
  EXPECT_FALSE(inlay_beyond(proof, excess, crossing, quads));
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

/// No more than a tenth of the result.
TEST(Inlays, MendComponentsThatHaveNothingAround) {
  const Case c = flat_sheets(10, 1, [](double x, double) { return x * (1 - x) - 2; });
  const QuadMesh quads = mended(c, 0.02);
  EXPECT_LT(quads.mesh.face_count(), 9 + 128);  // thinned out
  const PolyTopology topology = analyse(quads.mesh);
  EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
  EXPECT_EQ(topology.components, 10);
  EXPECT_EQ(topology.boundary_loops, 10);
}

/// Over a flat with small waves a vertex in the middle of n x n cells lies beyond its neighbours;
/// the outline of the cells around it crosses itself, so that the vertex cannot just be taken out.
Case crossed(Index n = 8) {
  Case c = grid(4 * n, n, [](double x, double y) { return 0.2 * terrain(x, y); });
  const Index middle = (n + 2) * (n / 2);
  std::swap(c.quads.provenance.face[middle], c.quads.provenance.face[middle + 1]);
  std::swap(c.quads.provenance.barycentric[middle], c.quads.provenance.barycentric[middle + 1]);
  std::swap(c.quads.mesh.positions[middle], c.quads.mesh.positions[middle + 1]);
  return c;
}

TEST(Inlays, MakeFacesThatCrossFewer) {
  const Case c = crossed();
  CrossingPlaces crossing(c.mesh);
  ASSERT_FALSE(crossing.faces_of(c.quads.mesh).empty());
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.02);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  const std::vector<char> is_of_inlay = inlay_crossing(proof, crossing, 0.02, quads);
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), 0.02).empty());
  EXPECT_TRUE(analyse(quads.mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(quads.mesh).euler, 1);
  ASSERT_EQ(is_of_inlay.size(), quads.mesh.positions.size());
  EXPECT_GT(std::ranges::count(is_of_inlay, 1), 4);
  // What is of none is of the result.
  for (std::size_t v = 0; v < is_of_inlay.size(); ++v) {
    if (is_of_inlay[v] != 0) continue;
    EXPECT_EQ(std::ranges::count(c.quads.mesh.positions, quads.mesh.positions[v]), 1);
  }
}

/// An inlay of the input's own faces has more vertices than the cells that it takes the place of; a
/// result for a count has no room for them.
TEST(Inlays, AddFewVerticesWhereFacesCross) {
  const Case c = crossed(24);
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.02);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  CrossingPlaces crossing(c.mesh);
  inlay_crossing(proof, crossing, 1e-6, quads);
  EXPECT_TRUE(crossing.faces_of(quads.mesh).empty());
  EXPECT_LE(quads.mesh.vertex_count(), 1.03 * c.quads.mesh.vertex_count());
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, quads), 0.02).empty());
}

/// The surface has a hole where faces of the result cross, which has one far away instead: only
/// what lies over hundreds of cells is like them.
TEST(Inlays, StayInProportionToWhatCrosses) {
  constexpr Index kCells = 40;
  const Index middle = (kCells + 1) * (kCells / 2);
  const Case c = with_holes(crossed(kCells), kCells, {middle + 8 * kCells}, {middle});
  CrossingPlaces crossing(c.mesh);
  ASSERT_FALSE(crossing.faces_of(c.quads.mesh).empty());
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.03);
  QuadMesh quads = c.quads;
  ASSERT_TRUE(proof.check(ComparedSurfaces(proof.input(), quads)).empty());
  EXPECT_TRUE(inlay_crossing(proof, crossing, 0.03, quads).empty());
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

/// Without a tolerance, and where other places are far from the surface.
TEST(Uncross, ReplacesOnlyWhatCrosses) {
  Case c = crossed();
  c.quads.mesh.positions[9 + 1].z() += 0.1;
  SilentObserver observer;
  CrossingPlaces crossing(c.mesh);
  const std::size_t before = crossing.faces_of(c.quads.mesh).size();
  ASSERT_GT(before, 0u);
  const UncrossResult result = uncross_faces(c.mesh, c.quads, observer);
  const PolyMesh& mesh = result.quads.mesh;
  EXPECT_EQ(crossing.faces_of(mesh).size(), 0u);
  const auto& entries = result.report.entries();
  const auto uncrossed = std::ranges::find(entries, "refine.uncrossed_faces",
                                           [](const auto& entry) { return entry.first; });
  ASSERT_NE(uncrossed, entries.end());
  EXPECT_EQ(std::get<std::int64_t>(uncrossed->second), static_cast<std::int64_t>(before));
  EXPECT_TRUE(analyse(mesh).is_oriented_manifold());
  EXPECT_EQ(analyse(mesh).euler, 1);
  // Cells around the lifted vertex stay, though nothing else is so far from the surface.
  const Vec3& lifted = c.quads.mesh.positions[9 + 1];
  EXPECT_EQ(std::ranges::count(mesh.positions, lifted), 1);
  // What is new is thinned out, paired, and no farther than the farthest place was.
  EXPECT_LT(mesh.vertex_count(), 81 + 24);
  Index new_quads = 0;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    const bool is_new = std::ranges::any_of(mesh.face(f), [&](Index v) {
      return std::ranges::count(c.quads.mesh.positions, mesh.positions[v]) == 0;
    });
    new_quads += is_new && mesh.face(f).size() == 4 ? 1 : 0;
  }
  EXPECT_GT(new_quads, 0);
  EXPECT_TRUE(check_tolerance(ComparedSurfaces(c.mesh, result.quads), 0.11).empty());
}

TEST(Uncross, LeavesWhatDoesNotCross) {
  const Case c = grid(32, 8, terrain);
  SilentObserver observer;
  const QuadMesh quads = uncross_faces(c.mesh, c.quads, observer).quads;
  EXPECT_EQ(quads.mesh.positions, c.quads.mesh.positions);
  EXPECT_EQ(quads.mesh.corners, c.quads.mesh.corners);
}

}  // namespace
}  // namespace strake
