#include "stages/evaluate/evaluate.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "common/core/error.h"
#include "common/core/place_text.h"
#include "common/core/tolerance_error.h"
#include "common/geometry/samples/samples.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/evaluate/evaluated.h"
#include "tests/unit/evaluate/shapes.h"

namespace strake {
namespace {

/// A tube of radius 1 around z with the exact curvature directions at its vertices.
struct Tube {
  TriMesh mesh;
  PrincipalField field;

  explicit Tube(Index n) : mesh(shapes::reference(twisted(n, n / 2, 0))) {
    field.mesh_id = mesh.id;
    for (Index w = 0; w < mesh.wedge_count(); ++w) {
      const Vec3& p = mesh.positions[mesh.wedge_vertex[w]];
      field.normal.push_back(Vec3(p.x(), p.y(), 0).normalized());
      field.t_min.push_back(Vec3::UnitZ());
      field.cross.push_back(w % 2 == 0 ? Vec3::UnitZ()
                                       : Vec3::UnitZ().cross(field.normal.back()).eval());
      field.k_min.push_back(0);
      field.k_max.push_back(1);
      field.wedge_confidence.push_back(1);
    }
    field.face_confidence.assign(mesh.faces.size(), 1);
  }

  /// Quads on the tube; lines that go up turn around it by `twist` times the height.
  static PolyMesh twisted(Index n, Index m, double twist) {
    return shapes::grid(n, m, true, false, [&](double s, double t) {
      const double height = std::numbers::pi * t;
      const double angle = 2 * std::numbers::pi * s + twist * height;
      return Vec3(std::cos(angle), std::sin(angle), height);
    });
  }
};

// The place is that of the file, wherever the model lies.
TEST(Evaluate, SaysWhereADetailIsMissing) {
  PolyMesh torus = shapes::torus(40, 20, 1, 0.3);
  torus.positions[0] *= 1.3;
  const Vec3 tip = torus.positions[0];
  const TriMesh reference = shapes::reference(torus);
  EXPECT_TRUE(evaluated(reference, torus).warnings().empty());
  const Report report = evaluated(reference, shapes::torus(40, 20, 1, 0.3));
  ASSERT_FALSE(report.warnings().empty());
  EXPECT_NE(report.warnings()[0].find("a detail is missing"), std::string::npos);
  EXPECT_NE(report.warnings()[0].find(place_text(tip, reference.diagonal)), std::string::npos);
}

TEST(Evaluate, RefusesWhatIsFartherThanATolerance) {
  const PolyMesh torus = shapes::torus(40, 20, 1, 0.3);
  const TriMesh reference = shapes::reference(torus);
  PolyMesh dented = torus;
  dented.positions[7] *= 0.9;
  EvaluateOptions options;
  options.samples = 20000;
  SilentObserver observer;
  const double largest =
      number(evaluate_mesh(reference, nullptr, dented, options, observer).report, "distance.max");
  options.tolerance = Length{1.001 * largest, false};
  EXPECT_NO_THROW(evaluate_mesh(reference, nullptr, dented, options, observer));
  options.tolerance = Length{0.999 * largest, false};
  try {
    evaluate_mesh(reference, nullptr, dented, options, observer);
    ADD_FAILURE() << "no error";
  } catch (const ToleranceError& error) {
    ASSERT_EQ(error.places().size(), 1u);
    const Vec3 place = error.places()[0] + reference.origin;
    // The vertex, or what of the torus was there before.
    EXPECT_LT(std::min((place - dented.positions[7]).norm(), (place - torus.positions[7]).norm()),
              1e-9);
  }
}

TEST(Evaluate, ASurfaceIsAtNoDistanceFromItself) {
  const PolyMesh torus = shapes::torus(40, 20, 1, 0.3);
  const Report report = evaluated(shapes::reference(torus), torus);
  EXPECT_NEAR(number(report, "distance.max"), 0, 1e-14);
  EXPECT_NEAR(number(report, "normals.max_deg"), 0, 1e-5);  // planar quads, either diagonal
  EXPECT_EQ(number(report, "topology.equal"), 1);
  EXPECT_TRUE(report.warnings().empty());
}

TEST(Evaluate, ParallelSquaresAreTheirHeightApart) {
  const double height = 0.25;
  const Report report =
      evaluated(shapes::reference(shapes::square(6, 0)), shapes::square(4, height));
  for (const std::string way : {"", "to_reference.", "from_reference."}) {
    for (const std::string figure : {"rms", "mean", "max"}) {
      EXPECT_NEAR(number(report, "distance." + way + figure), height, 1e-12);
      EXPECT_NEAR(number(report, "distance." + way + figure + "_share"),
                  height / std::numbers::sqrt2, 1e-12);
    }
    EXPECT_EQ(number(report, "normals." + way + "max_deg"), 0);
  }
}

TEST(Evaluate, CubesInsideEachOther) {
  const double h = 0.1;
  const Report report =
      evaluated(shapes::reference(shapes::cube(3, 0.5)), shapes::cube(2, 0.5 + h), nullptr, 100000);
  // From inside out every point is h away. From outside in: h over the inner face; over its edges
  // (4 strips of 1 x h) and corners (4 squares of h x h) the squares of one or two offsets in
  // [0, h], h^2 / 3 on average, come on top.
  const double area = (1 + 2 * h) * (1 + 2 * h);
  const double square = h * h * (1 + 4 * h * (4.0 / 3) + 4 * h * h * (5.0 / 3)) / area;
  EXPECT_NEAR(number(report, "distance.from_reference.rms"), h, 1e-12);
  EXPECT_NEAR(number(report, "distance.from_reference.max"), h, 1e-12);
  // Standard deviation of d^2 over its mean is below 0.4: plain random points would be within
  // 0.4 / sqrt(100000) / 2 = 0.06 % in the root; three times that.
  EXPECT_NEAR(number(report, "distance.to_reference.rms"), std::sqrt(square),
              0.002 * std::sqrt(square));
  EXPECT_NEAR(number(report, "distance.to_reference.max"), h * std::numbers::sqrt3, 1e-12);
  EXPECT_NEAR(number(report, "distance.rms"), std::sqrt((square + h * h) / 2), 0.002 * h);
}

// Above a pit in the form of a pyramid the middle of its widest sphere is farthest: on no vertex,
// and on a ridge, to which few samples come near.
TEST(Evaluate, TheLargestDistanceLiesBetweenVertices) {
  PolyMesh lid;
  for (const double y : {-1.0, 1.0}) {
    for (const double x : {-1.0, 1.0}) lid.positions.emplace_back(x, y, 0);
  }
  PolyMesh pit = lid;
  lid.add_face(std::array<Index, 4>{0, 1, 3, 2});
  const double apex = 0.3;
  pit.positions.emplace_back(apex, 0, -1);
  for (const auto& [a, b] : {std::pair{0, 1}, {1, 3}, {3, 2}, {2, 0}}) {
    pit.add_face(std::array<Index, 3>{a, b, 4});
  }
  // To the sides at x = 1 and -1 it is (1 - x) / right and (1 + x) / left, to the others more.
  const double right = std::hypot(1, 1 - apex);
  const double left = std::hypot(1, 1 + apex);
  const Report report = evaluated(shapes::reference(pit), lid, nullptr, 1000);
  EXPECT_NEAR(number(report, "distance.to_reference.max"), 2 / (left + right), 1e-4);
}

// What nobody sees is not measured: neither from its vertices nor to it.
TEST(Evaluate, FacesWithoutAreaAreNoSurface) {
  const PolyMesh square = shapes::square(3, 0);
  PolyMesh spiked = square;
  const Index first = spiked.vertex_count();
  for (const double x : {3.0, 5.0, 4.0}) spiked.positions.emplace_back(x, 0, 0);
  spiked.add_face(std::array<Index, 3>{first, first + 1, first + 2});
  EXPECT_NEAR(number(evaluated(shapes::reference(square), spiked), "distance.max"), 0, 1e-12);
  EXPECT_NEAR(number(evaluated(shapes::reference(spiked), square), "distance.max"), 0, 1e-12);
}

TEST(Evaluate, RoofsNormalsDeviateByItsSlope) {
  const double slope_deg = 20;
  const double rise = std::tan(slope_deg * std::numbers::pi / 180);
  const PolyMesh tilted = shapes::moved(
      shapes::square(3, 0), [&](const Vec3& p) { return Vec3(p.x(), p.y(), rise * p.x()); });
  const Report report = evaluated(shapes::reference(shapes::square(3, 0)), tilted);
  EXPECT_NEAR(number(report, "normals.mean_deg"), slope_deg, 1e-9);
  EXPECT_NEAR(number(report, "normals.rms_deg"), slope_deg, 1e-9);
  EXPECT_NEAR(number(report, "normals.max_deg"), slope_deg, 1e-6);
}

TEST(Evaluate, TurnedOverCandidateFacesAway) {
  PolyMesh turned = shapes::square(3, 0);
  for (Index f = 0; f < turned.face_count(); ++f) {
    std::reverse(turned.corners.begin() + turned.offsets[f],
                 turned.corners.begin() + turned.offsets[f + 1]);
  }
  const Report report = evaluated(shapes::reference(shapes::square(3, 0)), turned);
  EXPECT_EQ(number(report, "normals.facing_away_share"), 1);
  EXPECT_NEAR(number(report, "normals.mean_deg"), 180, 1e-9);
}

// A chord of a circle divided into n parts is 1 - cos(pi / n) off at most: halving quarters.
TEST(Evaluate, DistanceOfARefinedTorusConvergesQuadratically) {
  const TriMesh fine = shapes::reference(shapes::torus(480, 240, 1, 0.4));
  const double coarse = number(evaluated(fine, shapes::torus(24, 12, 1, 0.4)), "distance.rms");
  const double finer = number(evaluated(fine, shapes::torus(48, 24, 1, 0.4)), "distance.rms");
  EXPECT_NEAR(std::log2(coarse / finer), 2, 0.1);
}

TEST(Evaluate, SharesDoNotDependOnScaleOrPosition) {
  // Shaken, so that no two diagonals of a quad are equally long and rounding decides nothing.
  const PolyMesh fine = shapes::shaken(shapes::torus(60, 30, 1, 0.4), 0.01);
  const PolyMesh coarse = shapes::shaken(shapes::torus(30, 15, 1, 0.4), 0.02);
  const Eigen::AngleAxisd turn(1.1, Vec3(3, 1, 2).normalized());
  const double scale = 250;
  const auto move = [&](const Vec3& p) { return Vec3(scale * (turn * p)); };
  TriMesh moved_reference = shapes::reference(shapes::moved(fine, move));
  moved_reference.origin = Vec3(4e5, -1e6, 2e5);
  const PolyMesh moved_candidate =
      shapes::moved(coarse, [&](const Vec3& p) { return Vec3(move(p) + moved_reference.origin); });
  const Report before = evaluated(shapes::reference(fine), coarse);
  const Report after = evaluated(moved_reference, moved_candidate);
  // Coordinates of 1e6 carry an error of 1e-10, a share of 1e-12 of distances of 0.02 x scale.
  for (const std::string key : {"distance.rms", "distance.mean", "distance.max"}) {
    EXPECT_NEAR(number(after, key) / scale, number(before, key), 1e-9) << key;
  }
  for (const std::string key :
       {"normals.mean_deg", "normals.rms_deg", "angles.min_deg", "angles.max_deg",
        "angles.quad_deviation_mean_deg", "shape.aspect_mean", "shape.stretch_median",
        "shape.off_plane_mean", "faces.quad_area_share"}) {
    EXPECT_NEAR(number(after, key), number(before, key), 1e-5) << key;
  }
  EXPECT_EQ(number(after, "faces.concave"), number(before, "faces.concave"));
}

TEST(Evaluate, SameReportForAnyThreadCount) {
  const Tube tube(60);
  const PolyMesh candidate = shapes::shaken(Tube::twisted(20, 10, 0.2), 0.01);
  std::vector<Report> reports;
  for (const std::size_t threads : {1, 2, 7}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    reports.push_back(evaluated(tube.mesh, candidate, &tube.field));
  }
  EXPECT_EQ(reports[0].entries(), reports[1].entries());
  EXPECT_EQ(reports[0].entries(), reports[2].entries());
}

TEST(Evaluate, EdgesAlongCurvatureLinesAreAligned) {
  const Tube tube(120);
  const Report report = evaluated(tube.mesh, Tube::twisted(40, 20, 0), &tube.field);
  EXPECT_NEAR(number(report, "alignment.judged_share"), 1, 1e-12);
  EXPECT_NEAR(number(report, "alignment.mean_deg"), 0, 1e-6);
  EXPECT_NEAR(number(report, "alignment.within_10_deg_share"), 1, 1e-12);
  EXPECT_NEAR(number(report, "alignment.cross.mean_deg"), 0, 1e-6);
}

TEST(Evaluate, TwistedEdgesDeviateByTheirTwist) {
  const Tube tube(120);
  const double twist_deg = 17;
  const Index n = 96;
  const Index m = 40;
  const Report report = evaluated(
      tube.mesh, Tube::twisted(n, m, std::tan(twist_deg * std::numbers::pi / 180)), &tube.field);
  // Rings stay aligned; the lines that go up, n x m edges of this length, do not.
  const double rising = n * std::numbers::pi / std::cos(twist_deg * std::numbers::pi / 180);
  const double rings = (m + 1) * 2 * std::numbers::pi;
  const double expected = twist_deg * rising / (rising + rings);
  // Chords instead of arcs and flat faces of 3 degrees: second order in 0.08 rad, below 1 %.
  EXPECT_NEAR(number(report, "alignment.mean_deg"), expected, 0.01 * twist_deg);
  EXPECT_NEAR(number(report, "alignment.cross.mean_deg"), expected, 0.01 * twist_deg);
  EXPECT_NEAR(number(report, "alignment.within_10_deg_share"), rings / (rising + rings), 0.01);
}

TEST(Evaluate, IsotropicOrDoubtfulPlacesAreNotJudged) {
  Tube tube(40);
  tube.field.k_min.assign(tube.field.k_min.size(), 0.9);
  Report report = evaluated(tube.mesh, Tube::twisted(20, 10, 0), &tube.field);
  EXPECT_EQ(number(report, "alignment.judged_share"), 0);
  EXPECT_FALSE(has(report, "alignment.mean_deg"));
  EXPECT_TRUE(has(report, "alignment.cross.mean_deg"));
  tube.field.k_min.assign(tube.field.k_min.size(), 0);
  tube.field.face_confidence.assign(tube.field.face_confidence.size(), 0.5);
  report = evaluated(tube.mesh, Tube::twisted(20, 10, 0), &tube.field);
  EXPECT_EQ(number(report, "alignment.judged_share"), 0);
}

TEST(Evaluate, FieldOfAnotherMeshIsRefused) {
  const Tube tube(40);
  const Tube other(50);
  EXPECT_THROW(evaluated(tube.mesh, Tube::twisted(20, 10, 0), &other.field), PreconditionError);
}

TEST(Evaluate, FeaturesAreKeptOrLost) {
  const TriMesh cube = shapes::reference(shapes::cube(4, 0.5), 40);
  const Report kept = evaluated(cube, shapes::cube(3, 0.5));
  EXPECT_NEAR(number(kept, "features.reference_length"), 12, 1e-12);
  EXPECT_NEAR(number(kept, "features.kept_share"), 1, 1e-12);
  // The reach is 0.1 % of the diagonal sqrt(3): edges 0.002 x sqrt(2) away are lost.
  const Report lost = evaluated(cube, shapes::cube(3, 0.5 - 0.002));
  EXPECT_NEAR(number(lost, "features.kept_share"), 0, 1e-12);
}

TEST(Evaluate, ChordsKeepTheArcTheyStandFor) {
  // The rim of a disk of radius 1 in many steps, and polygons inscribed in it. A chord of an n-th
  // of a turn is 2 sin(pi/n) long and 1 - cos(pi/n) off the arc: 6.6 % of its length with 12
  // corners and 3.9 % with 20, both more than 0.1 % of the diagonal.
  const auto disk = [](int sides, double radius) {
    PolyMesh mesh;
    mesh.positions.push_back(Vec3::Zero());
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      mesh.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    for (Index i = 0; i < sides; ++i)
      mesh.add_face(std::array<Index, 3>{0, i + 1, (i + 1) % sides + 1});
    return mesh;
  };
  const TriMesh rim = shapes::reference(disk(240, 1));
  EXPECT_NEAR(number(evaluated(rim, disk(20, 1)), "boundary.kept_share"), 1, 1e-12);
  EXPECT_LT(number(evaluated(rim, disk(12, 1)), "boundary.kept_share"), 0.8);
  // A polygon of the same size whose corners are off the rim does not stand for it.
  EXPECT_LT(number(evaluated(rim, disk(20, 0.99)), "boundary.kept_share"), 0.1);
}

TEST(Evaluate, HalfASquareKeepsHalfTheBoundary) {
  const PolyMesh half =
      shapes::moved(shapes::square(4, 0), [](const Vec3& p) { return Vec3(p.x(), p.y() / 2, 0); });
  const Report report = evaluated(shapes::reference(shapes::square(5, 0)), half);
  EXPECT_NEAR(number(report, "boundary.reference_length"), 4, 1e-12);
  // Both sides are kept for 0.1 % of the diagonal more than they are long.
  const double reach = 0.001 * std::numbers::sqrt2;
  EXPECT_NEAR(number(report, "boundary.kept_share"), (2 + 2 * reach) / 4, reach / 2);
  EXPECT_FALSE(has(report, "features.kept_share"));
}

TEST(Evaluate, ValenceAndShapeOfARegularGrid) {
  const PolyMesh grid =
      shapes::moved(shapes::square(8, 0), [](const Vec3& p) { return Vec3(3 * p.x(), p.y(), 0); });
  const Report report = evaluated(shapes::reference(grid), grid);
  EXPECT_EQ(number(report, "valence.interior_vertices"), 7 * 7);
  EXPECT_EQ(number(report, "valence.share_4"), 1);
  EXPECT_EQ(number(report, "valence.t_joints"), 0);
  EXPECT_EQ(number(report, "faces.quad_share"), 1);
  EXPECT_NEAR(number(report, "faces.area"), 3, 1e-12);
  EXPECT_NEAR(number(report, "shape.stretch_median"), 3, 1e-12);
  EXPECT_NEAR(number(report, "shape.aspect_mean"), 3 * (2 * (1 + 3)) / (4 * 3.0), 1e-12);
  EXPECT_NEAR(number(report, "angles.quad_deviation_mean_deg"), 0, 1e-9);
  EXPECT_NEAR(number(report, "shape.jacobian_min"), 1, 1e-12);
}

TEST(Evaluate, TJointConcaveAndDegenerateFacesAreCounted) {
  // Vertex 4 in the middle of an edge of the pentagon: a T-joint. One dart and one sliver beside.
  PolyMesh mesh;
  mesh.positions = {{0, 0, 0},     {2, 0, 0},  {2, 1, 0},  {0, 1, 0},  {1, 1, 0},
                    {2, 2, 0},     {1, 2, 0},  {0, 2, 0},  {9, 0, 0},  {11, -1, 0},
                    {9.5, 0.4, 0}, {10, 3, 0}, {20, 0, 0}, {21, 0, 0}, {22, 1e-8, 0}};
  mesh.add_face(std::array<Index, 5>{0, 1, 2, 4, 3});
  mesh.add_face(std::array<Index, 4>{4, 2, 5, 6});
  mesh.add_face(std::array<Index, 4>{3, 4, 6, 7});
  mesh.add_face(std::array<Index, 4>{8, 9, 10, 11});
  mesh.add_face(std::array<Index, 3>{12, 13, 14});
  const Report report = evaluated(shapes::reference(shapes::square(3, 0)), mesh);
  EXPECT_EQ(number(report, "valence.t_joints"), 1);
  EXPECT_EQ(number(report, "faces.concave"), 1);
  EXPECT_EQ(number(report, "faces.flat_quads"), 1);
  EXPECT_EQ(number(report, "faces.degenerate"), 1);
  EXPECT_EQ(number(report, "faces.pentagons"), 1);
  EXPECT_GT(number(report, "angles.max_deg"), 180);
  EXPECT_EQ(number(report, "topology.equal"), 0);
}

TEST(Evaluate, FacesThatCrossAndSmallAnglesAreCounted) {
  const PolyMesh cube = shapes::cube(1, 1);
  const Report whole = evaluated(shapes::reference(cube), cube);
  EXPECT_EQ(number(whole, "shape.self_intersecting_pairs"), 0);
  EXPECT_EQ(number(whole, "angles.face_share_above_10_deg"), 1);
  // The four sides of a tower pass through the top of the cube.
  const PolyMesh tower = shapes::moved(
      cube, [](const Vec3& p) { return Vec3(p.x() / 9, p.y() / 9, 2 + 1.5 * p.z()); });
  const Report both = evaluated(shapes::reference(cube), support::together(cube, tower));
  EXPECT_EQ(number(both, "shape.self_intersecting_pairs"), 4);
  const PolyMesh sheared = shapes::moved(
      shapes::square(1, 0), [](const Vec3& p) { return Vec3(p.x() + 6 * p.y(), p.y(), 0); });
  const Report acute =
      evaluated(shapes::reference(cube), support::together(shapes::square(1, 2), sheared));
  EXPECT_EQ(number(acute, "angles.face_share_above_10_deg"), 0.5);
}

TEST(Evaluate, TopologyThatDiffersIsNamed) {
  PolyMesh broken = shapes::torus(20, 10, 1, 0.3);
  std::reverse(broken.corners.begin(), broken.corners.begin() + 4);
  const Report report = evaluated(shapes::reference(shapes::torus(20, 10, 1, 0.3)), broken);
  EXPECT_EQ(number(report, "topology.equal"), 0);
  EXPECT_EQ(number(report, "topology.candidate.misoriented_edges"), 4);
  EXPECT_FALSE(report.warnings().empty());
}

/// Of all samples every face would be equally near.
TEST(Evaluate, MeshesInOtherUnitsAreRefused) {
  SampleOptions options;
  options.faces = 800;
  const PolyMesh torus = make_sample(SampleKind::torus, options);
  const TriMesh reference = shapes::reference(torus);
  for (const double factor : {1e-12, 1e-6, 0.0009, 1100.0, 1e9}) {
    PolyMesh other = torus;
    for (Vec3& p : other.positions) p *= factor;
    EXPECT_THROW(evaluated(reference, other), PreconditionError) << factor;
  }
  PolyMesh away = torus;
  for (Vec3& p : away.positions) p += Vec3(0, 2e4, 0);
  EXPECT_THROW(evaluated(reference, away), PreconditionError);
}

TEST(Evaluate, MeshesThatCannotBeMeasuredAreRefused) {
  const TriMesh reference = shapes::reference(shapes::square(3, 0));
  PolyMesh infinite = shapes::square(3, 0);
  infinite.positions[5].x() = std::nan("");
  EXPECT_THROW(evaluated(reference, infinite), PreconditionError);
  const PolyMesh flat =
      shapes::moved(shapes::square(3, 0), [](const Vec3& p) { return Vec3(p.x(), 0, 0); });
  EXPECT_THROW(evaluated(reference, flat), PreconditionError);
}

}  // namespace
}  // namespace strake
