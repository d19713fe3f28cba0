#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/core/edge_list.h"
#include "common/core/error.h"
#include "tests/support/attributed.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;
using shapes::imported;

/// The rectangle from `corner` along two of its sides, n x m quads, looking along `x` times `y`.
PolyMesh rectangle(const Vec3& corner, const Vec3& x, const Vec3& y, int n, int m) {
  PolyMesh mesh = shapes::grid(n, m, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) p = Vec3(corner + p.x() * x + p.y() * y);
  return mesh;
}

PolyMesh jittered(PolyMesh mesh, double by) {
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    mesh.positions[v] +=
        by / std::sqrt(3.0) * Vec3(std::sin(5.0 * v), std::cos(3.0 * v), std::sin(7.0 * v));
  }
  return mesh;
}

/// A box whose side k has divisions[2 k] x divisions[2 k + 1] quads.
PolyMesh box(const Vec3& low, const Vec3& size, const std::array<int, 12>& divisions) {
  const Vec3 x(size.x(), 0, 0);
  const Vec3 y(0, size.y(), 0);
  const Vec3 z(0, 0, size.z());
  const std::array<std::array<Vec3, 3>, 6> sides = {
      {{low, y, x}, {low + z, x, y}, {low, x, z}, {low + y, z, x}, {low, z, y}, {low + x, y, z}}};
  PolyMesh mesh;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    const auto& [corner, along, up] = sides[k];
    mesh = support::together(mesh,
                             rectangle(corner, along, up, divisions[2 * k], divisions[2 * k + 1]));
  }
  return mesh;
}

/// One whose sides are divided each in its own way.
PolyMesh box(const Vec3& low, const Vec3& size) {
  return box(low, size, {3, 5, 4, 7, 6, 2, 3, 11, 5, 9, 8, 7});
}

void expect_closed(const ImportResult& result, Index genus) {
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.boundary_loops, 0);
  EXPECT_EQ(counts.genus, genus);
  EXPECT_EQ(count(result.report, "borders.near_edges"), 0);
  EXPECT_GT(count(result.report, "repairs.sewn_into_edges"), 0);
}

/// Nothing was joined, and the borders are those of the file.
void expect_untouched(const PolyMesh& mesh, Index components, Index loops) {
  const ImportResult result = imported(mesh);
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, components);
  EXPECT_EQ(counts.boundary_loops, loops);
  EXPECT_EQ(count(result.report, "repairs.sewn_into_edges"), 0);
  EXPECT_EQ(count(result.report, "repairs.sewn_vertices"), 0);
  EXPECT_EQ(result.mesh.vertex_count(), mesh.vertex_count());
}

TEST(SewDivided, SidesOfABoxThatAreDividedDifferently) {
  // Three walls meet at each corner, none divided like another one.
  for (const double by : {0.0, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5}) {
    const ImportResult result = imported(jittered(box(Vec3(-1, 2, 0), Vec3(1, 2, 3)), by));
    SCOPED_TRACE(by);
    expect_closed(result, 0);
    EXPECT_NEAR(shapes::area(result.mesh), 22, 50 * by + 1e-12);
    EXPECT_NEAR(shapes::volume(result.mesh), 6, 50 * by + 1e-12);
    EXPECT_EQ(count(result.report, "features.corners"), 8);
    EXPECT_EQ(count(result.report, "repairs.flipped_faces"), 0);
  }
}

TEST(SewDivided, AnyDivisionsAndNoise) {
  std::mt19937 random(1);
  const auto number = [&](int most) { return 1 + static_cast<int>(random() % most); };
  for (const double by : {1e-7, 1e-6, 1e-5, 1e-4}) {
    for (int round = 0; round < 25; ++round) {
      std::array<int, 12> divisions{};
      for (int& n : divisions) n = number(20);
      PolyMesh mesh = box(Vec3::Zero(), Vec3(1, 2, 3), divisions);
      for (Vec3& p : mesh.positions) {
        for (double& x : p) x += by * (number(1001) - 501) / 500.0;
      }
      const TriMesh result = imported(mesh).mesh;
      EXPECT_EQ(census(result).boundary_loops, 0) << by << ", round " << round;
      EXPECT_NEAR(shapes::volume(result), 6, 11 * by);
    }
  }
}

TEST(SewDivided, WhereverTheBoxLies) {
  for (const double size : {1e-3, 1.0, 1e4}) {
    const PolyMesh turned =
        support::transformed(box(Vec3(0, 0, 0), Vec3(1, 2, 3)), size * support::oblique_rotation(),
                             size * Vec3(30, -20, 10));
    const ImportResult result = imported(support::permuted(turned, 7).mesh);
    expect_closed(result, 0);
    EXPECT_NEAR(shapes::volume(result.mesh) / std::pow(size, 3), 6, 1e-9);
  }
}

TEST(SewDivided, AHousingWithAnOpening) {
  // A plate of 6 x 6 with a square hole, top and bottom of four rectangles that meet in T's.
  PolyMesh mesh;
  const auto add = [&](const PolyMesh& part) { mesh = support::together(mesh, part); };
  const Vec3 z(0, 0, 1);
  int n = 2;
  for (const bool is_top : {true, false}) {
    const auto flat = [&](double x, double y, double width, double depth) {
      const Vec3 a(width, 0, 0);
      const Vec3 b(0, depth, 0);
      const Vec3 corner(x, y, is_top ? 1 : 0);
      add(rectangle(corner, is_top ? a : b, is_top ? b : a, n, 2 * n - 3));
      ++n;
    };
    flat(0, 0, 6, 2);
    flat(0, 2, 2, 2);
    flat(4, 2, 2, 2);
    flat(0, 4, 6, 2);
  }
  const auto walls = [&](double low, double high, bool is_outer) {
    const std::array<Vec3, 4> corners = {Vec3(low, low, 0), Vec3(high, low, 0), Vec3(high, high, 0),
                                         Vec3(low, high, 0)};
    for (int k = 0; k < 4; ++k) {
      const Vec3 along = corners[(k + 1) % 4] - corners[k];
      if (is_outer) add(rectangle(corners[k], along, z, n, 1 + k % 3));
      if (!is_outer) add(rectangle(corners[k], z, along, 1 + k % 3, n));
      ++n;
    }
  };
  walls(0, 6, true);
  walls(2, 4, false);
  for (const double by : {0.0, 1e-6}) {
    const ImportResult result = imported(jittered(mesh, by));
    expect_closed(result, 1);
    EXPECT_NEAR(shapes::volume(result.mesh), 32, 200 * by + 1e-12);
    EXPECT_NEAR(shapes::area(result.mesh), 2 * 32 + 24 + 8, 200 * by + 1e-12);
  }
}

Vec3 on_circle(double share, double radius, double z) {
  const double angle = 2 * std::numbers::pi * share;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// A disc of one polygon of m sides around the z axis, looking up or down.
PolyMesh disc(int m, double radius, double z, bool is_up) {
  PolyMesh mesh;
  std::vector<Index> around;
  for (int i = 0; i < m; ++i) {
    around.push_back(i);
    mesh.positions.push_back(on_circle(double(is_up ? i : -i) / m, radius, z));
  }
  mesh.add_face(around);
  return mesh;
}

/// The wall of a cylinder of radius 1 and height 2 from one share of the circle to another.
PolyMesh wall(int n, int m, double from, double to) {
  PolyMesh mesh = shapes::grid(n, m, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) p = on_circle(from + (to - from) * p.x(), 1, 2 * p.y());
  return mesh;
}

/// A cylinder whose wall has n and whose caps have m vertices around, these of another radius or
/// farther apart.
PolyMesh cylinder(int n, int m, double radius = 1, double lift = 0) {
  const PolyMesh caps =
      support::together(disc(m, radius, 2 + lift, true), disc(m, radius, -lift, false));
  return support::together(wall(n, 3, 0, 1), caps);
}

TEST(SewDivided, CapsOfACylinderThatAreDividedDifferently) {
  // Vertices of a rim are beside the chords of the other: of 192 by 0.004 % of the diagonal, of 14
  // by 0.7 %, far more than any gap that is sewn elsewhere.
  for (const auto& [n, m] : {std::pair(192, 128), std::pair(96, 192), std::pair(32, 64),
                             std::pair(64, 32), std::pair(48, 31), std::pair(23, 37),
                             std::pair(14, 200), std::pair(100, 15), std::pair(17, 16)}) {
    for (const double by : {0.0, 1e-6, 1e-5}) {
      SCOPED_TRACE(testing::Message() << n << ", " << m << ", " << by);
      const ImportResult result = imported(jittered(cylinder(n, m), by));
      expect_closed(result, 0);
      EXPECT_NEAR(shapes::volume(result.mesh), 2 * std::numbers::pi,
                  14.0 / std::min(n * n, m * m) * 3);
    }
  }
}

TEST(SewDivided, AWallOfTwoHalvesThatAreDividedDifferently) {
  for (const double by : {0.0, 1e-6}) {
    const PolyMesh walls = support::together(wall(13, 4, 0, 0.5), wall(19, 7, 0.5, 1));
    const PolyMesh caps = support::together(disc(25, 1, 2, true), disc(40, 1, 0, false));
    expect_closed(imported(jittered(support::together(walls, caps), by)), 0);
  }
}

TEST(SewDivided, ADiscInAPlate) {
  const auto plate = [](double radius) {
    PolyMesh ring = shapes::grid(40, 2, [](double, double) { return 0.0; });
    for (Vec3& p : ring.positions) p = on_circle(-p.x(), 1 + p.y(), 0);
    return support::together(ring, disc(27, radius, 0, true));
  };
  const ImportResult result = imported(plate(1));
  EXPECT_EQ(census(result.mesh).components, 1);
  EXPECT_EQ(census(result.mesh).boundary_loops, 1);
  EXPECT_EQ(count(result.report, "repairs.flipped_faces"), 0);
  EXPECT_EQ(census(imported(plate(0.99)).mesh).components, 2);
}

TEST(SewDivided, ALidWithClearanceIsNoneThatIsDividedDifferently) {
  // The chords of 32 are 0.005 off their circle; the clearance is less, as much, and more.
  for (const double radius : {0.98, 0.99, 0.995, 0.998, 1.002, 1.005, 1.01}) {
    const ImportResult result = imported(cylinder(32, 48, radius));
    EXPECT_EQ(census(result.mesh).components, 3) << radius;
    EXPECT_EQ(count(result.report, "repairs.sewn_into_edges"), 0) << radius;
  }
  for (const double lift : {-1e-2, 2e-3, 1e-2}) {
    EXPECT_EQ(census(imported(cylinder(32, 48, 1, lift)).mesh).components, 3) << lift;
  }
}

TEST(SewDivided, AnEdgeWithAVertexInside) {
  // The loop of a crack without width: one edge on one side, two on the other.
  const PolyMesh mesh = shapes::polygons({{0, 0, 0}, {2, 0, 0}, {1, 1, 0}, {1, 0, 0}, {1, -1, 0}},
                                         {{0, 1, 2}, {0, 4, 3}, {3, 4, 1}});
  const ImportResult result = imported(mesh);
  EXPECT_EQ(census(result.mesh).boundary_loops, 1);
  EXPECT_EQ(result.mesh.face_count(), 4);
  EXPECT_EQ(result.mesh.vertex_count(), 5);
  EXPECT_NEAR(shapes::area(result.mesh), 2, 1e-15);
  EXPECT_EQ(count(result.report, "repairs.sewn_into_edges"), 1);
}

TEST(SewDivided, PatchesThatAreTurnedOver) {
  const ImportResult result =
      imported(shapes::turned(box(Vec3(0, 0, 0), Vec3(1, 2, 3)), [](Index f) { return f < 15; }));
  expect_closed(result, 0);
  EXPECT_GT(count(result.report, "repairs.flipped_faces"), 0);
}

TEST(SewDivided, NoSurfaceOfOneSideIsMade) {
  // A band whose ends meet, turned by half a turn or a whole one, and are divided differently.
  const auto band = [](int half_turns) {
    PolyMesh mesh = shapes::grid(60, 4, [](double, double) { return 0.0; });
    PolyMesh last = shapes::grid(1, 7, [](double, double) { return 0.0; });
    for (Vec3& p : mesh.positions) p.x() *= 60.0 / 61;
    for (Vec3& p : last.positions) p.x() = (60 + p.x()) / 61;
    mesh = support::together(mesh, last);
    for (Vec3& p : mesh.positions) {
      const double turn = std::numbers::pi * half_turns * p.x();
      const double r = 2 + (p.y() - 0.5) * std::cos(turn);
      const double angle = 2 * std::numbers::pi * p.x();
      p = Vec3(r * std::cos(angle), r * std::sin(angle), (p.y() - 0.5) * std::sin(turn));
    }
    return imported(mesh);
  };
  const ImportResult whole = band(2);
  EXPECT_EQ(census(whole.mesh).boundary_loops, 2);
  EXPECT_EQ(count(whole.report, "repairs.non_orientable_cuts"), 0);
  const ImportResult half = band(1);
  EXPECT_EQ(census(half.mesh).components, 1);
  EXPECT_EQ(census(half.mesh).boundary_loops, 1);
  EXPECT_EQ(count(half.report, "repairs.non_orientable_cuts"), 0);
}

TEST(SewDivided, NothingJoinsASurfaceOfOneSide) {
  // A band with so many half turns, and a patch beside six of its edges that has twelve.
  const auto imported_with = [](int half_turns) {
    const auto place = [&](double x, double y) {
      const double turn = std::numbers::pi * half_turns * x;
      const double r = 2 + (y - 0.5) * std::cos(turn);
      const double angle = 2 * std::numbers::pi * x;
      return Vec3(r * std::cos(angle), r * std::sin(angle), (y - 0.5) * std::sin(turn));
    };
    PolyMesh band = shapes::grid(60, 4, [](double, double) { return 0.0; });
    for (Vec3& p : band.positions) p = place(p.x(), p.y());
    PolyMesh patch = shapes::grid(12, 1, [](double, double) { return 0.0; });
    for (Vec3& p : patch.positions) {
      const double edges = 6 + 6 * p.x();  // from the band's start on
      const double y = 1 + 0.3 * p.y();
      const double share = edges - std::floor(edges);
      p = (1 - share) * place(std::floor(edges) / 60, y) + share * place(std::ceil(edges) / 60, y);
    }
    return imported(support::together(band, patch));
  };
  EXPECT_EQ(census(imported_with(2).mesh).components, 1);
  const ImportResult half = imported_with(1);
  EXPECT_EQ(census(half.mesh).components, 2);
  EXPECT_EQ(count(half.report, "repairs.sewn_into_edges"), 0);
  EXPECT_EQ(count(half.report, "repairs.non_orientable_cuts"), 4);
}

/// Two sheets, 1 x 1, beside each other, `gap(y)` apart, of 8 and 5 edges along it.
template <typename Gap>
PolyMesh pair_of_sheets(const Gap& gap) {
  const PolyMesh one = shapes::grid(8, 8, [](double, double) { return 0.0; });
  PolyMesh other = shapes::grid(5, 5, [](double, double) { return 0.0; });
  for (Vec3& p : other.positions) p += Vec3(1 + gap(p.y()), 0, 0);
  return support::together(one, other);
}

TEST(SewDivided, SheetsBesideEachOtherBecomeOne) {
  const ImportResult result = imported(pair_of_sheets([](double) { return 0.0; }));
  EXPECT_EQ(census(result.mesh).components, 1);
  EXPECT_EQ(census(result.mesh).boundary_loops, 1);
  EXPECT_NEAR(shapes::area(result.mesh), 2, 1e-12);
  EXPECT_EQ(result.mesh.vertex_count(), 9 * 9 + 6 * 6 - 2);
  EXPECT_EQ(count(result.report, "repairs.sewn_into_edges"), 7 + 4);
  EXPECT_EQ(count(result.report, "repairs.sewn_vertices"), 2);
}

TEST(SewDivided, AGapThatIsOpenAllAlongStays) {
  for (const double gap : {1e-4, 3e-4, 1e-3, 1e-2}) {
    expect_untouched(pair_of_sheets([&](double) { return gap; }), 2, 2);
  }
  // Borders that overlap in one place and gape in another are patches that miss each other.
  const ImportResult crossing =
      imported(pair_of_sheets([](double y) { return 2e-4 * std::sin(12 * y); }));
  EXPECT_EQ(census(crossing.mesh).components, 1);
}

TEST(SewDivided, SheetsOfAThinShellStayApart) {
  const PolyMesh outer = shapes::grid(8, 8, [](double, double) { return 0.0; });
  for (const double thickness : {1e-5, 1e-4, 1e-3}) {
    const PolyMesh inner = shapes::turned(
        shapes::grid(5, 5, [&](double, double) { return -thickness; }), [](Index) { return true; });
    expect_untouched(support::together(outer, inner), 2, 2);
  }
}

TEST(SewDivided, TheWallsOfAThinPlateAreSewnToTheirOwnSides) {
  // 1e-4 of the diagonal thick, which is nearer than borders may be to be sewn.
  for (const double by : {0.0, 1e-8}) {
    const ImportResult result = imported(jittered(box(Vec3(0, 0, 0), Vec3(1, 1, 1.4e-4)), by));
    const Census counts = census(result.mesh);
    EXPECT_EQ(counts.components, 1);
    EXPECT_EQ(counts.boundary_loops, 0);
    EXPECT_NEAR(shapes::volume(result.mesh), 1.4e-4, 4 * by + 1e-12);
  }
}

TEST(SewDivided, HolesAndSheetsThatTouchInAPointStay) {
  const PolyMesh sheet = shapes::grid(4, 4, [](double, double) { return 0.0; });
  expect_untouched(shapes::filtered(sheet, [](Index f) { return f != 5; }), 1, 2);
  // A corner that touches the middle of an edge.
  PolyMesh other = support::transformed(
      sheet, Eigen::AngleAxisd(std::numbers::pi / 4, Vec3::UnitZ()).toRotationMatrix(),
      Vec3(0.625, 1, 0));
  expect_untouched(support::together(sheet, other), 2, 2);
}

TEST(SewDivided, ClosedSolidsThatTouchAreNotJoined) {
  const ImportResult one = imported(box(Vec3(0, 0, 0), Vec3(1, 2, 3)));
  PolyMesh closed;
  closed.positions = one.mesh.positions;
  for (const auto& face : one.mesh.faces) closed.add_face(face);
  PolyMesh other = closed;
  for (Vec3& p : other.positions) p = Vec3(p.x() + 1, 1.3 * p.y(), p.z() + 0.2);
  expect_untouched(support::together(closed, other), 2, 0);
}

TEST(SewDivided, NoneOfThreeSheetsThatMeetIsPreferred) {
  const auto leaves = [](double gap) {
    PolyMesh mesh;
    for (int k = 0; k < 3; ++k) {
      const double angle = 2 * std::numbers::pi * k / 3;
      const Vec3 way(std::cos(angle), std::sin(angle), 0);
      mesh = support::together(mesh, rectangle(gap * way, way, Vec3(0, 0, 1), 4, 3 + k));
    }
    return mesh;
  };
  expect_untouched(leaves(1e-5), 3, 3);
  // Without a gap all are joined, and taken apart again as none goes on flat in another.
  EXPECT_EQ(census(imported(leaves(0)).mesh).components, 3);
}

TEST(SewDivided, SolidsThatTouchAlongAnEdgeStayClosed) {
  const PolyMesh pair =
      support::together(box(Vec3(0, 0, 0), Vec3(1, 2, 3)), box(Vec3(1, 2, 0), Vec3(2, 1, 3)));
  const Census counts = census(imported(pair).mesh);
  EXPECT_EQ(counts.boundary_loops, 0);
  EXPECT_EQ(counts.components, 2);
}

TEST(SewDivided, LabelsColoursAndTextureStay) {
  PolyMesh mesh = pair_of_sheets([](double) { return 0.0; });
  support::colour_linearly(mesh);
  FaceLabels labels{"g", {}, {"one", "other"}};
  for (Index f = 0; f < mesh.face_count(); ++f) labels.of_face.push_back(f < 64 ? 0 : 1);
  mesh.attributes.labels = {labels};
  for (const Index v : mesh.corners) {
    mesh.attributes.texture.push_back({3 * mesh.positions[v].x(), 2 * mesh.positions[v].y()});
  }
  const TriMesh result = imported(mesh).mesh;
  ASSERT_EQ(result.attributes.labels.size(), 1U);
  for (Index f = 0; f < result.face_count(); ++f) {
    double x = 0;
    for (int k = 0; k < 3; ++k) {
      const Vec3& p = result.positions[result.faces[f][k]];
      const TexturePoint& texture = result.attributes.texture[3 * f + k];
      EXPECT_NEAR(texture[0], 3 * p.x(), 1e-12);
      EXPECT_NEAR(texture[1], 2 * p.y(), 1e-12);
      x += p.x() / 3;
    }
    EXPECT_EQ(result.attributes.labels[0].of_face[f], x < 1 ? 0 : 1);
  }
  for (Index v = 0; v < result.vertex_count(); ++v) {
    EXPECT_NE(result.source_vertex[v], kNone);
    EXPECT_NEAR(result.attributes.colour[v][0], support::linear_colour(result.positions[v])[0],
                1e-12);
  }
}

TEST(SewDivided, ListedEdgesAreFollowedAlongTheirParts) {
  PolyMesh mesh = pair_of_sheets([](double) { return 0.0; });
  // The side that both have in common, from below as the second sheet numbers it.
  EdgeList list{{}, "list"};
  for (Index j = 0; j < 5; ++j) list.edges.push_back({81 + 6 * (j + 1), 81 + 6 * j, j + 1});
  SilentObserver observer;
  const ImportResult result = import_mesh(mesh, shapes::undivided(), observer, &list);
  EXPECT_EQ(count(result.report, "features.listed_edges"), 8 + 5 - 1);
}

TEST(SewDivided, WhatWasSewnIsToldAndRefusedByStrict) {
  const PolyMesh mesh = box(Vec3(0, 0, 0), Vec3(1, 2, 3));
  const std::vector<std::string> warnings = imported(mesh).report.warnings();
  EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
    return warning.find("borders that are divided differently") != std::string::npos;
  }));
  ImportOptions options = shapes::undivided();
  options.strict = true;
  EXPECT_THROW(imported(mesh, options), InputError);
}

}  // namespace
}  // namespace strake
