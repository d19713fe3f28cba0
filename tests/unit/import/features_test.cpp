#include "stages/import/features.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::imported;

constexpr double kDegree = std::numbers::pi / 180;

/// A unit square folded along x = 1/2 by `angle_deg`, where `fade(y)` scales the fold's slope.
template <typename Fade>
PolyMesh fold(double angle_deg, int n, const Fade& fade) {
  const double slope = std::tan(0.5 * angle_deg * kDegree);
  return shapes::grid(
      n, n, [&](double x, double y) { return slope * fade(y) * (0.5 - std::abs(x - 0.5)); });
}

double unfaded(double) { return 1; }

Index corners(const TriMesh& mesh) {
  return static_cast<Index>(std::count(mesh.is_corner.begin(), mesh.is_corner.end(), 1));
}

Index feature_edges(const TriMesh& mesh) {
  return static_cast<Index>(std::count(mesh.is_feature.begin(), mesh.is_feature.end(), 1)) / 2;
}

/// A cube whose faces are grids of n x n quads.
PolyMesh fine_cube(int n) {
  PolyMesh all;
  for (int side = 0; side < 6; ++side) {
    PolyMesh sheet = shapes::grid(n, n, [](double, double) { return 0.0; });
    for (Vec3& p : sheet.positions) {
      const Vec3 q(p.x(), p.y(), side < 3 ? 0 : 1);
      p = side % 3 == 0 ? q
                        : (side % 3 == 1 ? Vec3(q.z(), q.x(), q.y()) : Vec3(q.y(), q.z(), q.x()));
    }
    all = support::together(all, shapes::turned(sheet, [&](Index) { return side < 3; }));
  }
  return shapes::merged(all);
}

TEST(Features, EdgesOfACubeAndItsCorners) {
  for (const int n : {1, 2, 10}) {
    const TriMesh mesh = imported(fine_cube(n)).mesh;
    EXPECT_EQ(feature_edges(mesh), 12 * n);
    EXPECT_EQ(corners(mesh), 8);
    for (Index h = 0; h < mesh.halfedge_count(); ++h) {
      EXPECT_EQ(mesh.is_feature[h] != 0, support::dihedral_angle(mesh, h) > 0.5) << h;
    }
  }
}

/// Faces of these lengths one after the other, bent in between; `n` quads along them.
PolyMesh strips(const std::vector<double>& lengths, const std::vector<double>& bends_deg, int n) {
  std::vector<Vec2> section{Vec2(0, 0)};
  double slope = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (i > 0) slope -= bends_deg[i - 1] * kDegree;
    section.push_back(section.back() + lengths[i] * Vec2(std::cos(slope), std::sin(slope)));
  }
  const auto count = static_cast<int>(lengths.size());
  PolyMesh mesh = shapes::grid(count, n, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) {
    const Vec2& q = section[std::lround(p.x() * count)];
    p = Vec3(q.x(), p.y(), q.y());
  }
  return mesh;
}

/// A round of so many bends between two long faces.
PolyMesh round(double bend_deg, int bends, double width) {
  std::vector<double> lengths(bends + 1, width);
  lengths.front() = lengths.back() = 1;
  return strips(lengths, std::vector<double>(bends, bend_deg), 20);
}

/// Between half of it and the angle itself an edge must stand alone.
TEST(Features, TheAngleDecidesOnSmoothFaces) {
  for (const double angle : {39.0, 41.0}) {
    const TriMesh mesh = imported(round(angle, 4, 0.05)).mesh;
    EXPECT_EQ(feature_edges(mesh), angle > 40 ? 4 * 20 : 0);
  }
  for (const double angle : {19.0, 21.0}) {
    const ImportResult result = imported(fold(angle, 20, unfaded));
    EXPECT_EQ(feature_edges(result.mesh), angle > 20 ? 20 : 0);
    EXPECT_EQ(shapes::count(result.report, "features.shallow_edges"), angle > 20 ? 20 : 0);
  }
  EXPECT_EQ(feature_edges(imported(fold(170, 20, unfaded), {.feature_angle_deg = 180}).mesh), 0);
  EXPECT_EQ(feature_edges(imported(fold(12, 20, unfaded), {.feature_angle_deg = 10}).mesh), 20);
}

TEST(Features, CoarseRoundsAreSmoothHoweverFewFacesTheyHave) {
  for (const int bends : {2, 3, 6}) {
    EXPECT_EQ(feature_edges(imported(round(25, bends, 0.05)).mesh), 0) << bends;
  }
  PolyMesh cylinder = shapes::grid(16, 20, [](double, double) { return 0.0; });
  for (Vec3& p : cylinder.positions) {
    const double angle = static_cast<double>(std::lround(16 * p.x()) % 16) * 22.5 * kDegree;
    p = Vec3(std::cos(angle), std::sin(angle), p.y());
  }
  EXPECT_EQ(feature_edges(imported(shapes::merged(cylinder)).mesh), 0);
}

/// A cone of `sides` triangles that meet in its tip, standing on a plate around it.
PolyMesh cone(int sides, double height) {
  PolyMesh soup;
  soup.positions.emplace_back(0, 0, height);
  for (const double radius : {1.0, 2.0}) {
    for (int i = 0; i < sides; ++i) {
      const double angle = 360.0 / sides * i * kDegree;
      soup.positions.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
  }
  for (Index i = 0; i < sides; ++i) {
    const Index next = (i + 1) % sides;
    soup.add_face(std::array<Index, 3>{0, 1 + i, 1 + next});
    soup.add_face(std::array<Index, 4>{1 + i, 1 + sides + i, 1 + sides + next, 1 + next});
  }
  return soup;
}

/// The spokes at the tip are bent, and more than all other edges around one of the base.
TEST(Features, TheBaseOfACoarseConeIsKept) {
  for (const int sides : {8, 12, 20, 32}) {
    EXPECT_EQ(feature_edges(imported(cone(sides, 1.7)).mesh), sides);
    EXPECT_EQ(feature_edges(imported(cone(sides, 1)).mesh), sides);
  }
}

/// Where faces are wide, edges without neighbours of their kind on both sides are kept.
TEST(Features, WideFacesAreNoRound) {
  EXPECT_EQ(feature_edges(imported(round(25, 2, 0.4)).mesh), 2 * 20);
  EXPECT_EQ(feature_edges(imported(round(25, 6, 0.4)).mesh), 2 * 20);
}

/// Beside a sharp edge there is no round, however narrow the face in between.
TEST(Features, BothEdgesOfAChamferAreKept) {
  EXPECT_EQ(feature_edges(imported(strips({1, 0.05, 1}, {30, 60}, 20)).mesh), 2 * 20);
}

/// A block of 4 x 3 x 2 all of whose edges are chamfered by 45 degrees.
PolyMesh chamfered_block(double chamfer) {
  const Vec3 half(2, 1.5, 1);
  const auto sign = [](int corner, int axis) { return ((corner >> axis) & 1) != 0 ? 1 : -1; };
  std::vector<Vec3> positions;
  for (int corner = 0; corner < 8; ++corner) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3& p = positions.emplace_back(half - Vec3::Constant(chamfer));
      p[axis] = half[axis];
      for (int i = 0; i < 3; ++i) p[i] *= sign(corner, i);
    }
  }
  std::vector<std::vector<Index>> faces;
  for (int a = 0; a < 3; ++a) {
    const int b = 1 << ((a + 1) % 3);
    const int c = 1 << ((a + 2) % 3);
    for (const int low : {0, 1 << a}) {  // the side across this axis
      faces.push_back({3 * low + a, 3 * (low + b) + a, 3 * (low + b + c) + a, 3 * (low + c) + a});
    }
    for (const int low : {0, b, c, b + c}) {  // the chamfers along it
      const int high = low + (1 << a);
      const int one = (a + 1) % 3;
      const int other = (a + 2) % 3;
      faces.push_back({3 * low + one, 3 * high + one, 3 * high + other, 3 * low + other});
    }
  }
  for (int corner = 0; corner < 8; ++corner) {
    faces.push_back({3 * corner, 3 * corner + 1, 3 * corner + 2});
  }
  return shapes::polygons(positions, faces);
}

/// Edges of the corners are bent by 35 degrees, and are most of what is bent there.
TEST(Features, WhereChamfersMeetThereIsNoNoise) {
  for (const double chamfer : {0.02, 0.1, 0.5}) {
    const TriMesh mesh = imported(chamfered_block(chamfer)).mesh;
    EXPECT_EQ(feature_edges(mesh), 48) << chamfer;
    EXPECT_EQ(corners(mesh), 24);
  }
}

/// A lens: its caps are bent towards each other all over, but hardly beside its edge.
TEST(Features, EdgesBetweenCurvedFacesAreKept) {
  const PolyMesh lens = shapes::grid(40, 20, [](double x, double) {
    const double from_edge = std::abs(x - 0.5);
    return -std::tan(13 * kDegree) * from_edge + 0.2 * from_edge * from_edge;
  });
  EXPECT_EQ(feature_edges(imported(lens).mesh), 20);
}

/// A rib on a square plate: its slope begins at a toe as wide as the rib, and ends after `run`.
PolyMesh ribbed_plate(double slope_deg, double width, double run) {
  const double low = 0.5 - width / 2;
  const double high = 0.5 + width / 2;
  const double back = 0.3 + run;
  const double top = run * std::tan(slope_deg * kDegree);
  return shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
                           Vec3(0.3, low, 0), Vec3(0.3, high, 0), Vec3(back, low, 0),
                           Vec3(back, high, 0), Vec3(back, low, top), Vec3(back, high, top)},
                          {{0, 1, 6, 4},
                           {1, 2, 7, 6},
                           {2, 3, 5, 7},
                           {3, 0, 4, 5},
                           {4, 8, 9, 5},
                           {4, 6, 8},
                           {7, 5, 9},
                           {6, 7, 9, 8}});
}

/// The toe is 1.4 % of the diagonal long.
TEST(Features, ShortEdgesAcrossStripsBetweenCreasesAreKept) {
  for (const double slope : {19.0, 25.0, 35.0}) {
    EXPECT_EQ(feature_edges(imported(ribbed_plate(slope, 0.02, 0.4)).mesh), slope > 20 ? 9 : 8)
        << slope;
  }
}

/// Those that close a bend of a crease are no strips' ends, as on scans.
TEST(Features, ShortEdgesWithCreasesNearAreNone) {
  EXPECT_EQ(feature_edges(imported(ribbed_plate(25, 0.06, 0.04)).mesh), 8);
}

/// A flat pyramid amid a plate: what is bent there ends nowhere.
TEST(Features, SmallBumpsHaveNoEdges) {
  constexpr double kHalf = 0.004;
  const double top = kHalf * std::tan(25 * kDegree);
  PolyMesh mesh = shapes::polygons(
      {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0),
       Vec3(0.5 - kHalf, 0.5 - kHalf, 0), Vec3(0.5 + kHalf, 0.5 - kHalf, 0),
       Vec3(0.5 + kHalf, 0.5 + kHalf, 0), Vec3(0.5 - kHalf, 0.5 + kHalf, 0), Vec3(0.5, 0.5, top)},
      {{0, 1, 5, 4},
       {1, 2, 6, 5},
       {2, 3, 7, 6},
       {3, 0, 4, 7},
       {4, 5, 8},
       {5, 6, 8},
       {6, 7, 8},
       {7, 4, 8}});
  EXPECT_EQ(feature_edges(imported(mesh).mesh), 0);
}

/// The same with its tip cut off: a flat whose edges are all bent, but none that ends on a crease.
TEST(Features, SmallFrustumsHaveNoEdges) {
  std::vector<Vec3> positions = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 1, 0)};
  for (const Vec3& ring : {Vec3(0.004, 0.004, 0), Vec3(0.002, 0.002, 0.001)}) {
    for (const Vec2& side : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
      positions.emplace_back(0.5 + ring.x() * side.x(), 0.5 + ring.y() * side.y(), ring.z());
    }
  }
  std::vector<std::vector<Index>> faces = {{8, 9, 10, 11}};
  for (Index ring = 0; ring < 8; ring += 4) {
    for (Index i = 0; i < 4; ++i) {
      const Index next = (i + 1) % 4;
      faces.push_back({ring + i, ring + next, ring + 4 + next, ring + 4 + i});
    }
  }
  EXPECT_EQ(feature_edges(imported(shapes::polygons(positions, faces)).mesh), 0);
}

ImportOptions with_facets(double height) {
  ImportOptions options = shapes::undivided();
  options.facet_height = Length{height, false};
  return options;
}

/// Strips a twentieth wide, but for the first and the last one.
TEST(Features, EdgesOfFacetsStandOutByMoreThanTheHeight) {
  const PolyMesh mesh = round(25, 6, 0.05);
  const double height = 0.05 * std::sin(12.5 * kDegree);
  EXPECT_EQ(feature_edges(imported(mesh, with_facets(0.9 * height)).mesh), 6 * 20);
  EXPECT_EQ(feature_edges(imported(mesh, with_facets(1.1 * height)).mesh), 2 * 20);
  EXPECT_EQ(feature_edges(imported(mesh, with_facets(2.1 * height)).mesh), 0);
  // Of three edges two are high.
  EXPECT_EQ(feature_edges(imported(round(25, 3, 0.05), with_facets(1.1 * height)).mesh), 3 * 20);
  EXPECT_EQ(feature_edges(imported(round(9, 6, 0.05), with_facets(1e-6)).mesh), 0);
}

/// A dome: of quads no two of whose edges lie in a plane triangles are bent at every edge.
TEST(Features, TriangulationsOfRoundShapesHaveNoFacets) {
  const PolyMesh dome = shapes::grid(
      8, 8, [](double x, double y) { return 0.5 * std::sin(3 * x) * std::sin(3 * y); });
  EXPECT_EQ(feature_edges(imported(dome, with_facets(1e-6)).mesh),
            feature_edges(imported(dome).mesh));
}

TEST(Features, RidgesStandOutByMoreThanTheHeightAtAnyAngle) {
  constexpr int kSteps = 20;
  for (const double angle : {3.0, 12.0, 19.0}) {
    const double height = std::tan(0.5 * angle * kDegree) / kSteps;
    for (const double factor : {0.99, 1.01}) {
      ImportOptions options = shapes::undivided();
      options.feature_height = Length{factor * height, false};
      const TriMesh mesh = imported(fold(angle, kSteps, unfaded), options).mesh;
      EXPECT_EQ(feature_edges(mesh), factor < 1 ? kSteps : 0) << angle << " degrees";
    }
  }
}

/// Coarser meshes of the same fold stand out more.
TEST(Features, RidgesDependOnTheSizeOfFaces) {
  ImportOptions options = shapes::undivided();
  options.feature_height = percent(1);
  EXPECT_EQ(feature_edges(imported(fold(12, 4, unfaded), options).mesh), 4);
  EXPECT_EQ(feature_edges(imported(fold(12, 20, unfaded), options).mesh), 0);
}

TEST(Features, CreaseMeetsTheBoundaryInCorners) {
  const TriMesh mesh = imported(fold(80, 20, unfaded)).mesh;
  // Four of the square and two where the crease ends.
  EXPECT_EQ(corners(mesh), 6);
}

TEST(Features, GapInACreaseIsBridged) {
  // Bent by 50 degrees, but by 30 in the middle: more than 0.6 * 40.
  const double least = std::tan(15 * kDegree) / std::tan(25 * kDegree);
  const TriMesh mesh = imported(fold(50, 40, [&](double y) {
                         const double dip = std::cos(std::numbers::pi * (y - 0.5));
                         return 1 - (1 - least) * dip * dip;
                       })).mesh;
  EXPECT_EQ(feature_edges(mesh), 40);
  // Where it fades out for good it ends: 2 atan(tan(25) (1 - y)) falls below 20 degrees at 0.62.
  const TriMesh fading = imported(fold(50, 40, [](double y) { return 1 - y; })).mesh;
  EXPECT_NEAR(feature_edges(fading), 0.62 * 40, 1);
}

TEST(Features, TinyPiecesAreNoise) {
  // A roof of three vertices on a fine grid: bent by 50 degrees along its ridge, by 25 at its foot.
  const int n = 400;
  PolyMesh mesh = shapes::grid(n, n, [](double, double) { return 0.0; });
  for (const int j : {199, 200, 201}) {
    mesh.positions[j * (n + 1) + 200].z() = std::tan(25 * kDegree) / n;
  }
  const ImportResult result = imported(mesh);
  EXPECT_GT(shapes::count(result.report, "features.strong_edges"), 0);
  EXPECT_EQ(feature_edges(result.mesh), 0);
}

TEST(Features, NoiseIsNoCrease) {
  PolyMesh mesh = shapes::grid(80, 80, [](double, double) { return 0.0; });
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.2 / 80);
  for (Vec3& p : mesh.positions) p.z() += noise(random);
  const ImportResult result = imported(mesh);
  // Height differences of 0.2 sqrt 2 edges bend many edges by more than 40 degrees.
  EXPECT_LT(feature_edges(result.mesh), 80 * 80 * 3 / 100);
}

/// Points on the lines of a scanner, fifteen times as close along a line as from line to line, with
/// noise as high as they are close, on the share `noisy` of the unit square.
PolyMesh scan_lines(double noisy) {
  constexpr int kAlong = 300;
  PolyMesh mesh = shapes::grid(kAlong, 20, [](double, double) { return 0.0; });
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.4 / kAlong);
  for (Vec3& p : mesh.positions) {
    if (p.x() <= noisy) p.z() += noise(random);
  }
  return mesh;
}

/// Noise bends most of the long edges by more than 40 degrees there, which join to webs.
TEST(Features, NoiseOnScanLinesIsNoCrease) {
  for (const double noisy : {1.0, 0.3}) {
    const ImportResult result = imported(scan_lines(noisy));
    EXPECT_LT(feature_edges(result.mesh), noisy * 300 * 20 * 3 / 50) << noisy;
  }
}

/// Bent to and fro as noise is, but with flats between.
TEST(Features, OfACorrugatedPlateAllAreKept) {
  constexpr int kFolds = 20;
  const PolyMesh mesh = shapes::grid(kFolds, 10, [](double x, double) {
    return std::lround(x * kFolds) % 2 == 0 ? 0.0 : 1.0 / kFolds;
  });
  EXPECT_EQ(feature_edges(imported(mesh).mesh), (kFolds - 1) * 10);
}

TEST(Features, SliversDoNotTurnTheirNeighboursIntoCreases) {
  // A flat square with a triangle of no height on the diagonal, its apex off by rounding.
  for (const double offset : {-1e-9, 0.0, 1e-9}) {
    const TriMesh mesh = imported(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                                    Vec3(0, 1, 0), Vec3(0.5 + offset, 0.5, offset)},
                                                   {{0, 1, 2}, {0, 2, 4}, {2, 3, 4}, {3, 0, 4}}))
                             .mesh;
    EXPECT_EQ(feature_edges(mesh), 0) << offset;
  }
}

/// Models on a map have all digits it takes to lie there.
TEST(Features, AreTheSameFarFromTheOrigin) {
  constexpr int kSides = 720;
  PolyMesh needles;  // a cylinder whose lids are fans of thin triangles
  for (int i = 0; i < kSides; ++i) {
    const double t = 2 * std::numbers::pi * i / kSides;
    for (const double z : {0.0, 1.0}) needles.positions.emplace_back(std::cos(t), std::sin(t), z);
  }
  for (const Index z : {0, 1}) needles.positions.emplace_back(0, 0, z);
  for (Index i = 0; i < kSides; ++i) {
    const Index a = 2 * i;
    const Index b = 2 * ((i + 1) % kSides);
    needles.add_face(std::array<Index, 4>{a, b, b + 1, a + 1});
    needles.add_face(std::array<Index, 3>{2 * kSides, b, a});
    needles.add_face(std::array<Index, 3>{2 * kSides + 1, a + 1, b + 1});
  }
  for (const double away : {0.0, 100.0, 3000.0, 1e5}) {
    PolyMesh moved = needles;
    for (Vec3& p : moved.positions) p += away * Vec3(1, 0.3, -0.2);
    const ImportResult result = shapes::imported(moved, shapes::undivided());
    EXPECT_EQ(shapes::count(result.report, "features.edges"), 2 * kSides) << away;
  }
}

TEST(Corners, OfCoarseBrackets) {
  for (const int n : {1, 2, 3, 4, 10}) {
    const PolyMesh bracket =
        shapes::grid(2 * n, n, [](double x, double) { return -std::abs(2 * x - 1); });
    const TriMesh mesh = shapes::imported(bracket, shapes::undivided()).mesh;
    Index corners = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      if (mesh.is_corner[v] == 0) continue;
      ++corners;
      const Vec3 p = mesh.positions[v] + mesh.origin;
      const double off = std::min({std::abs(p.x()), std::abs(p.x() - 0.5), std::abs(p.x() - 1)}) +
                         std::min(std::abs(p.y()), std::abs(p.y() - 1));
      EXPECT_LT(off, 1e-12) << n << ": " << p.transpose();
    }
    EXPECT_EQ(corners, 6) << n;
  }
}

TEST(Corners, OfASquareAndNoneOfADisk) {
  const PolyMesh square = shapes::grid(30, 30, [](double, double) { return 0.0; });
  EXPECT_EQ(corners(imported(square).mesh), 4);
  PolyMesh disk = square;
  for (Vec3& p : disk.positions) {
    // Square rings become circles.
    const Vec3 q = 2 * p - Vec3(1, 1, 0);
    const double radius = std::max(std::abs(q.x()), std::abs(q.y()));
    p = q.norm() > 0 ? Vec3(radius * q.normalized()) : Vec3(Vec3::Zero());
  }
  EXPECT_EQ(corners(imported(disk).mesh), 0);
}

TEST(Corners, RaggedBoundariesHaveFew) {
  PolyMesh mesh = shapes::grid(100, 100, [](double, double) { return 0.0; });
  std::mt19937 random(3);
  std::uniform_real_distribution<double> shift(-0.004, 0.004);
  for (Vec3& p : mesh.positions) p += Vec3(shift(random), shift(random), 0);
  const TriMesh result = imported(mesh).mesh;
  Index boundary_vertices = 0;
  for (Index v = 0; v < result.vertex_count(); ++v) {
    boundary_vertices += result.is_boundary(result.vertex_out[v]) ? 1 : 0;
  }
  EXPECT_GE(corners(result), 4);
  EXPECT_LE(corners(result), 8);
  EXPECT_EQ(boundary_vertices, 400);
}

TEST(Corners, AreWhereOtherThanTwoLinesMeet) {
  const TriMesh mesh = imported(fine_cube(6)).mesh;
  std::vector<Index> degree(mesh.vertex_count(), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) degree[mesh.from(h)] += mesh.is_feature[h];
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    if (degree[v] == 2) continue;
    EXPECT_EQ(mesh.is_corner[v] != 0, degree[v] != 0);
  }
}

}  // namespace
}  // namespace strake
