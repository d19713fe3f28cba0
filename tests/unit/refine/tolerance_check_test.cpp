#include "common/geometry/cell_error/tolerance_check.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>

#include "common/core/error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "tests/support/mesh_support.h"
#include "tests/support/result_cases.h"

namespace strake {
namespace {

using support::bent_strip;
using support::Case;
using support::grid;

std::vector<Index> cells_in_doubt(const ComparedSurfaces& surfaces, double tolerance) {
  return ToleranceProof(surfaces.shared_input(), tolerance).cells_in_doubt(surfaces);
}

bool is_within(const Case& c, double tolerance) {
  return check_tolerance(ComparedSurfaces(c.mesh, c.quads), tolerance).empty();
}

/// Moves inner vertices of a result within the plane, so that faces of the input lie over several
/// of its own.
void shift_within(Case& c, double most, std::mt19937& random) {
  std::uniform_real_distribution<double> shift(-most, most);
  for (Vec3& p : c.quads.mesh.positions) {
    for (int axis = 0; axis < 2; ++axis) {
      if (p[axis] > 0 && p[axis] < 1) p[axis] += shift(random);
    }
  }
}

/// A plane lifted by d is d away, everywhere and both ways.
TEST(ToleranceCheck, FindsTheDistanceOfParallelPlanes) {
  Case c = grid(8, 2, [](double, double) { return 0.0; });
  for (Vec3& p : c.quads.mesh.positions) p.z() += 0.01;
  // 1 % more than the distance, so that pieces may stick out of a triangle by a seventh of it.
  EXPECT_TRUE(is_within(c, 0.0101));
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const std::vector<Excess> excess = check_tolerance(surfaces, 0.01 * (1 - 1e-9));
  // Every triangle of both surfaces.
  EXPECT_EQ(excess.size(), surfaces.triangles().corners.size() + c.mesh.faces.size());
  for (const Excess& e : excess) EXPECT_NEAR(e.distance, 0.01, 1e-12);
}

/// Planes hardly nearer than the tolerance take many pieces. With a limit a proof takes no more,
/// and says so; that it does not depends on the sum alone.
TEST(ToleranceProof, KeepsToALimit) {
  Case c = grid(8, 2, [](double, double) { return 0.0; });
  for (Vec3& p : c.quads.mesh.positions) p.z() += 0.01;
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const auto fits = [&](std::int64_t limit) {
    ToleranceProof proof(surfaces.shared_input(), 0.0102);
    proof.limit(limit);
    try {
      return proof.check(surfaces).empty();
    } catch (const ProofTooLong&) {
      return false;
    }
  };
  std::int64_t too_few = 0;
  std::int64_t least = 1;
  while (!fits(least)) least *= 2;
  while (least - too_few > 1) {
    const std::int64_t middle = (too_few + least) / 2;
    (fits(middle) ? least : too_few) = middle;
  }
  EXPECT_GT(least, 100);
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(fits(least));
    EXPECT_FALSE(fits(least - 1));
  }
}

/// One vertex of the input sticks out by h, in the middle of a face of the result. Samples on a
/// grid of any width but one can miss it; the check cannot.
TEST(ToleranceCheck, FindsASpikeOfTheInput) {
  const double h = 0.02;
  const Case c = grid(16, 1, [&](double x, double y) { return x == 0.5 && y == 0.5 ? h : 0.0; });
  EXPECT_TRUE(is_within(c, 1.001 * h));
  const std::vector<Excess> excess = check_tolerance(ComparedSurfaces(c.mesh, c.quads), 0.999 * h);
  ASSERT_FALSE(excess.empty());
  for (const Excess& e : excess) {
    EXPECT_NE(e.input_face, kNone);
    EXPECT_NEAR(e.distance, h, 1e-12);
    EXPECT_LT((e.place - Vec3(0.5, 0.5, h)).norm(), 1e-12);
  }
}

/// Two triangles over the same four corners, joined along one diagonal and along the other: apart
/// by h where the diagonals cross, which no corner and no halving of edges comes upon, and by less
/// everywhere else.
TEST(ToleranceCheck, FindsWhatLiesBetweenAllCorners) {
  const double h = 0.01;
  PolyMesh along;
  along.positions = {Vec3(0, 0, 0), Vec3(0.3, -0.6, h), Vec3(1, 0, 0), Vec3(0.3, 0.9, h)};
  PolyMesh across = along;
  along.add_face(std::array<Index, 3>{0, 1, 2});
  along.add_face(std::array<Index, 3>{0, 2, 3});
  across.add_face(std::array<Index, 3>{0, 1, 3});
  across.add_face(std::array<Index, 3>{1, 2, 3});
  Case c;
  c.mesh = support::plain_tri_mesh(along);
  c.quads.mesh = across;
  // On the result the faces below are inclined by h / 0.6: the distance is cos(atan(h / 0.6)) h.
  EXPECT_FALSE(is_within(c, 0.999 * h));
  EXPECT_TRUE(is_within(c, 1.01 * h));
}

/// A unit square, and beside it a triangle of length one that has this height.
PolyMesh square_and_needle(double height) {
  PolyMesh mesh;
  mesh.positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),       Vec3(0, 1, 0),
                    Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1.5, height, 0)};
  mesh.add_face(std::array<Index, 3>{0, 1, 2});
  mesh.add_face(std::array<Index, 3>{0, 2, 3});
  mesh.add_face(std::array<Index, 3>{4, 5, 6});
  return mesh;
}

/// Nobody sees a triangle without area: it takes the place of nothing, and nothing must take its.
TEST(ToleranceCheck, TrianglesWithoutAreaAreNoSurface) {
  const PolyMesh thin = square_and_needle(0.01);
  const PolyMesh flat = square_and_needle(0);
  PolyMesh square;
  square.positions.assign(thin.positions.begin(), thin.positions.begin() + 4);
  for (Index f = 0; f < 2; ++f) square.add_face(thin.face(f));
  const auto is_near = [](const PolyMesh& input, const PolyMesh& result) {
    Case c;
    c.mesh = support::plain_tri_mesh(input);
    c.quads.mesh = result;
    return is_within(c, 0.1);
  };
  EXPECT_FALSE(is_near(thin, flat));
  EXPECT_FALSE(is_near(flat, thin));
  EXPECT_FALSE(is_near(thin, square));
  EXPECT_TRUE(is_near(flat, square));
  EXPECT_TRUE(is_near(square, flat));
  EXPECT_TRUE(is_near(flat, flat));
  EXPECT_TRUE(is_near(thin, thin));
}

/// Two ways to cut the same plane into triangles, far larger than the tolerance: pieces that
/// straddle an edge of the other surface are cut there. Halved, they would be some ten million.
TEST(ToleranceCheck, ProvesLargeFlatsWithinASmallTolerance) {
  Case c = grid(8, 2, [](double, double) { return 0.0; });
  std::mt19937 random(1);
  shift_within(c, 0.05, random);
  EXPECT_TRUE(is_within(c, 1e-6));
}

/// Only one of the ways to cut it is the surface.
TEST(ToleranceCheck, FindsCellsThatRoundingMayCutBeyondTheTolerance) {
  for (const double shift : {0.0, -1e-12, 1e-12}) {
    PolyMesh pentagon = support::undecided_pentagon();
    pentagon.positions[3].y() += shift;
    std::vector<FaceTriangles> cuts = other_triangulations(pentagon);
    ASSERT_FALSE(cuts.empty());
    cuts.push_back(triangulate_faces(pentagon));
    for (const FaceTriangles& cut : cuts) {
      const Case c = support::on_triangles(pentagon, cut);
      const ComparedSurfaces surfaces(c.mesh, c.quads);
      const bool is_within = check_tolerance(surfaces, 0.1).empty();
      EXPECT_TRUE(!is_within || cells_in_doubt(surfaces, 0.1) == std::vector<Index>{0});
      // As far as corner 3 is from the others' plane, and more.
      EXPECT_TRUE(check_tolerance(surfaces, 0.7).empty());
      EXPECT_TRUE(cells_in_doubt(surfaces, 0.7).empty());
    }
  }
}

/// On random terrain: where the check accepts, no sample is farther; where it refuses, the largest
/// distance found among samples and places is as near to the tolerance as its smallest pieces are.
TEST(ToleranceCheck, AgreesWithSamplesOnTerrain) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> height(0, 0.05);
    const Case c = grid(12, 3, [&](double, double) { return height(random); });
    const ComparedSurfaces surfaces(c.mesh, c.quads);
    const double sampled = measure_cells(surfaces).largest;
    EXPECT_FALSE(is_within(c, 0.999 * sampled));
    // The distance changes by no more than one moves: kSmallestPiece of the tolerance.
    double low = sampled;
    double high = 0.06;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (low + high);
      (is_within(c, middle) ? high : low) = middle;
    }
    for (const Excess& e : check_tolerance(surfaces, 0.99 * high)) {
      EXPECT_GE(e.distance, 0.95 * high);
    }
  }
}

/// The faces in reverse order.
void turn_round(PolyMesh& mesh) {
  PolyMesh turned;
  for (Index f = mesh.face_count() - 1; f >= 0; --f) turned.add_face(mesh.face(f));
  mesh.corners = turned.corners;
  mesh.offsets = turned.offsets;
}

class ToleranceProofOf : public testing::TestWithParam<double> {};

/// Whatever changes from one result to the next, and back again.
TEST_P(ToleranceProofOf, ResultsInARowFindsWhatNewChecksFind) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> height(0, 0.02);
  std::uniform_real_distribution<double> lift(-0.1, 0.1);
  Case c = grid(24, 6, [&](double, double) { return height(random); });
  shift_within(c, GetParam(), random);
  const std::vector<Vec3> places = c.quads.mesh.positions;
  constexpr double kTolerance = 0.03;
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), kTolerance);
  int within = 0;
  for (int step = 0; step < 40; ++step) {
    if (step % 4 == 3) c.quads.mesh.positions = places;
    if (step % 4 == 1) {
      c.quads.mesh.positions[random() % places.size()].z() += lift(random);
    }
    if (step % 5 == 4) turn_round(c.quads.mesh);
    const ComparedSurfaces surfaces(proof.input(), c.quads);
    const std::vector<Excess> found = proof.check(surfaces);
    const std::vector<Excess> expected = check_tolerance(surfaces, kTolerance);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].cell, expected[i].cell);
      EXPECT_EQ(found[i].input_face, expected[i].input_face);
      EXPECT_EQ(found[i].place, expected[i].place);
      EXPECT_EQ(found[i].distance, expected[i].distance);
    }
    within += found.empty() ? 1 : 0;
  }
  EXPECT_GT(within, 10);
  EXPECT_LT(within, 30);
}
INSTANTIATE_TEST_SUITE_P(Shifts, ToleranceProofOf, testing::Values(0.0, 0.03));

/// Two faces of the input under 64 of the result: each of its inner vertices in turn is lifted.
TEST(ToleranceProof, CanBeCancelledBetweenChecks) {
  class Cancel : public Observer {
   public:
    void report(std::string_view phase, double /*fraction*/) override {
      if (phase == "proving") throw Interrupted();
    }
  };
  const Case c = grid(4, 1, [](double, double) { return 0.0; });
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.01);
  const ComparedSurfaces surfaces(proof.input(), c.quads);
  EXPECT_TRUE(proof.check(surfaces).empty());
  Cancel cancel;
  proof.report_to(cancel, "proving");
  EXPECT_THROW(proof.check(surfaces), Interrupted);
}

TEST(ToleranceProof, WatchesAllThatAFaceIsNearTo) {
  const auto flat = [](double, double) { return 0.0; };
  Case c = grid(8, 8, flat);
  const TriMesh square = grid(1, 1, flat).mesh;
  ToleranceProof proof(std::make_shared<const InputSurface>(square), 0.01);
  for (Vec3& p : c.quads.mesh.positions) {
    EXPECT_TRUE(proof.check(ComparedSurfaces(proof.input(), c.quads)).empty());
    if (p.x() == 0 || p.x() == 1 || p.y() == 0 || p.y() == 1) continue;
    p.z() = 0.05;
    const std::vector<Excess> found = proof.check(ComparedSurfaces(proof.input(), c.quads));
    const auto is_on_input = [](const Excess& e) { return e.input_face != kNone; };
    EXPECT_TRUE(std::ranges::any_of(found, is_on_input));
    p.z() = 0;
  }
}

/// A result far from the surface is taken as it is; what is farther then is found, of either.
TEST(ToleranceProof, ChecksOnlyWhatIsNotAsItWasAssumed) {
  Case c = grid(16, 8, [](double, double) { return 0.0; });
  for (Vec3& p : c.quads.mesh.positions) p.z() += 0.05;
  ToleranceProof proof(std::make_shared<const InputSurface>(c.mesh), 0.01);
  proof.assume(ComparedSurfaces(proof.input(), c.quads));
  EXPECT_TRUE(proof.check(ComparedSurfaces(proof.input(), c.quads)).empty());
  const Vec3 moved = c.quads.mesh.positions[4 * 9 + 4];
  c.quads.mesh.positions[4 * 9 + 4].z() += 0.1;
  const std::vector<Excess> found = proof.check(ComparedSurfaces(proof.input(), c.quads));
  const auto is_on_input = [](const Excess& e) { return e.input_face != kNone; };
  EXPECT_TRUE(std::ranges::any_of(found, is_on_input));
  EXPECT_FALSE(std::ranges::all_of(found, is_on_input));
  const double cell = 1.0 / 8;
  for (const Excess& e : found) {
    EXPECT_LT(std::abs(e.place.x() - moved.x()), 1.5 * cell);
    EXPECT_LT(std::abs(e.place.y() - moved.y()), 1.5 * cell);
  }
  EXPECT_LT(found.size(), check_tolerance(ComparedSurfaces(c.mesh, c.quads), 0.01).size());
  c.quads.mesh.positions[4 * 9 + 4] = moved;  // as it was assumed again
  EXPECT_TRUE(proof.check(ComparedSurfaces(proof.input(), c.quads)).empty());
}

/// Of a result that is far off everywhere, only what is not assumed.
TEST(ToleranceProof, ChecksCellsThatAreNotAssumed) {
  Case c = grid(16, 8, [](double, double) { return 0.0; });
  for (Vec3& p : c.quads.mesh.positions) p.z() += 0.05;
  const auto input = std::make_shared<const InputSurface>(c.mesh);
  const ComparedSurfaces surfaces(input, c.quads);
  const auto all = static_cast<std::size_t>(c.quads.mesh.face_count());
  for (const std::size_t cell : {std::size_t{0}, std::size_t{27}, all - 1}) {
    std::vector<char> is_checked(all, 0);
    is_checked[cell] = 1;
    ToleranceProof proof(input, 0.01);
    proof.assume(surfaces, is_checked);
    const std::vector<Excess> found = proof.check(surfaces);
    std::size_t of_result = 0;
    for (const Excess& e : found) {
      if (e.input_face != kNone) continue;
      ++of_result;
      EXPECT_EQ(e.cell, static_cast<Index>(cell));
    }
    EXPECT_EQ(of_result, 2u);  // its triangles
    EXPECT_GT(found.size(), of_result);
    EXPECT_LT(found.size(), check_tolerance(surfaces, 0.01).size() / 4);
  }
}

/// The same excesses for any number of threads, and when both surfaces are moved.
TEST(ToleranceCheck, DependsOnNeitherPlaceNorScale) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> height(0, 0.05);
  const Case c = grid(12, 3, [&](double, double) { return height(random); });
  Case large = c;
  for (Vec3& p : large.mesh.positions) p *= 1024;
  for (Vec3& p : large.quads.mesh.positions) p *= 1024;
  const auto a = check_tolerance(ComparedSurfaces(c.mesh, c.quads), 0.02);
  const auto b = check_tolerance(ComparedSurfaces(large.mesh, large.quads), 0.02 * 1024);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].cell, b[i].cell);
}

/// A strip bent along x by curvature k: heights k x^2 / 2 about its middle, none along y.
TEST(CellError, FindsWhichWayTheSurfaceBends) {
  const double k = 0.3;
  const Case c = bent_strip(k);
  const ComparedSurfaces surfaces(c.mesh, c.quads);
  const ErrorMap errors = measure_cells(surfaces);
  for (const CellError& cell : errors.cells) {
    EXPECT_NEAR(std::abs(Vec3::UnitX().dot(cell.bend * Vec3::UnitX())), k / 2, 0.1 * k);
    EXPECT_NEAR(Vec3::UnitY().dot(cell.bend * Vec3::UnitY()), 0, 0.02 * k);
  }
  // A chord of length 1 of a parabola of curvature k is off by k / 8, in the mean square by
  // sqrt(8 / 15) of that.
  EXPECT_NEAR(errors.largest, k / 8, 0.02 * k / 8);
  EXPECT_NEAR(errors.rms, std::sqrt(8.0 / 15) * k / 8, 0.03 * k / 8);
}

}  // namespace
}  // namespace strake
