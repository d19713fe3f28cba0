#include "common/geometry/topology/closed_components.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <ctime>
#include <initializer_list>
#include <string>

#include "common/geometry/poly_topology/poly_topology.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

/// A cube around `middle` of this half side; a negative one looks inwards.
PolyMesh box(const Vec3& middle, double half) {
  PolyMesh cube = shapes::cube(Vec3::Constant(-0.5));
  for (Vec3& p : cube.positions) p = middle + 2 * std::abs(half) * p;
  return half > 0 ? cube : shapes::turned(cube, [](Index) { return true; });
}

PolyMesh all_of(std::initializer_list<PolyMesh> parts) {
  PolyMesh mesh;
  for (const PolyMesh& part : parts) mesh = support::together(mesh, part);
  return mesh;
}

/// Judges a mesh as it is, and turned and far away, before and after import.
void expect_judged(const PolyMesh& mesh, Index inside_out, Index cavities) {
  const PolyMesh far =
      support::transformed(mesh, 1e-2 * support::oblique_rotation(), Vec3(1e3, -2e3, 500));
  for (const PolyMesh* each : {&mesh, &far}) {
    const ClosedComponents read = judge_closed_components(*each);
    const ClosedComponents made = judge_closed_components(shapes::imported(*each).mesh);
    for (const ClosedComponents& closed : {read, made}) {
      EXPECT_EQ(closed.count, analyse(mesh).components);
      EXPECT_EQ(closed.inside_out, inside_out);
      EXPECT_EQ(closed.cavities, cavities);
    }
  }
}

const Vec3 kOrigin = Vec3::Zero();
const Vec3 kAside = Vec3(10, 1, 2);

TEST(ClosedComponents, EachIsJudgedByItself) {
  expect_judged(box(kOrigin, 1), 0, 0);
  expect_judged(box(kOrigin, -1), 1, 0);
  expect_judged(all_of({box(kOrigin, 3), box(kAside, -1)}), 1, 0);
  expect_judged(all_of({box(kOrigin, 1), box(kAside, -3)}), 1, 0);
  expect_judged(all_of({box(kOrigin, -1), box(kAside, -1)}), 2, 0);
}

TEST(ClosedComponents, CavitiesLieInsideWhatLooksOutwards) {
  expect_judged(all_of({box(kOrigin, 3), box(kOrigin, -1)}), 0, 1);
  expect_judged(all_of({box(kOrigin, 3), box(kOrigin, 1)}), 0, 0);
  expect_judged(all_of({box(kOrigin, -3), box(kOrigin, -1)}), 2, 0);
  expect_judged(all_of({box(kOrigin, -3), box(kOrigin, 1)}), 1, 0);
  // What stands inside a cavity is a solid again.
  expect_judged(all_of({box(kOrigin, 4), box(kOrigin, -3), box(kOrigin, 1)}), 0, 1);
  expect_judged(all_of({box(kOrigin, 4), box(kOrigin, -3), box(kOrigin, -1)}), 1, 1);
  // Inside in part, or above and below: none.
  expect_judged(all_of({box(kOrigin, 3), box(Vec3(3, 0.1, 0.2), -1)}), 1, 0);
  expect_judged(all_of({box(kOrigin, 1), box(Vec3(0.1, 0.2, 5), -3)}), 1, 0);
  expect_judged(all_of({box(kOrigin, 1), box(Vec3(0.1, 0.2, -5), -3)}), 1, 0);
}

// Points on upright faces lie in the planes of others above and below.
TEST(ClosedComponents, CavitiesMayBeInLine) {
  const PolyMesh row = all_of(
      {box(kOrigin, 8), box(Vec3(0, 0, -4), -1), box(Vec3(0, 0, 0), -1), box(Vec3(0, 0, 4), -1)});
  // A step, 1 wide and high and 4 deep, and a cavity whose side is below its upright.
  const PolyMesh step = shapes::polygons(
      {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(2, 0, 2), Vec3(1, 0, 2), Vec3(1, 0, 1), Vec3(0, 0, 1),
       Vec3(0, 4, 0), Vec3(2, 4, 0), Vec3(2, 4, 2), Vec3(1, 4, 2), Vec3(1, 4, 1), Vec3(0, 4, 1)},
      {{0, 1, 2, 3, 4, 5},
       {11, 10, 9, 8, 7, 6},
       {1, 0, 6, 7},
       {2, 1, 7, 8},
       {3, 2, 8, 9},
       {4, 3, 9, 10},
       {5, 4, 10, 11},
       {0, 5, 11, 6}});
  for (unsigned seed = 0; seed < 20; ++seed) {
    EXPECT_EQ(judge_closed_components(support::permuted(row, seed).mesh).cavities, 3) << seed;
    for (const double x : {0.875, 1.125}) {
      const PolyMesh hollow = all_of({step, box(Vec3(x, 1.7, 0.5), -0.125)});
      EXPECT_EQ(judge_closed_components(support::permuted(hollow, seed).mesh).cavities, 1) << seed;
    }
  }
}

/// Processor time that it takes to judge rows of cubes that look inwards, in a plane across an
/// axis.
double time_to_judge(int rows, int axis) {
  const PolyMesh cube = box(kOrigin, -1);
  PolyMesh mesh;
  for (int i = 0; i < rows * rows; ++i) {
    Vec3 middle = Vec3::Zero();
    middle[(axis + 1) % 3] = 3 * (i / rows);
    middle[(axis + 2) % 3] = 3 * (i % rows);
    const Index first = mesh.vertex_count();
    for (const Vec3& p : cube.positions) mesh.positions.push_back(p + middle);
    for (const Index v : cube.corners) mesh.corners.push_back(first + v);
    while (mesh.offsets.back() != static_cast<Index>(mesh.corners.size())) {
      mesh.offsets.push_back(mesh.offsets.back() + 4);
    }
  }
  const std::clock_t start = std::clock();
  EXPECT_EQ(judge_closed_components(mesh).inside_out, rows * rows);
  return static_cast<double>(std::clock() - start);
}

// Each was compared with all others of the same x.
TEST(ClosedComponents, TakeAsLongInEveryPlane) {
  const double across_z = time_to_judge(80, 2);
  for (const int axis : {0, 1}) EXPECT_LT(time_to_judge(80, axis), 3 * across_z) << axis;
}

TEST(ClosedComponents, AreTurnedOutwardsWithTheirCavities) {
  const auto expect_turned = [](const PolyMesh& mesh, const PolyMesh& wanted) {
    ImportOptions options;
    options.outwards = true;
    const ImportResult result = shapes::imported(mesh, options);
    EXPECT_NEAR(shapes::volume(result.mesh), shapes::volume(shapes::imported(wanted).mesh), 1e-9);
    EXPECT_EQ(judge_closed_components(result.mesh).inside_out, 0);
    validate(result.mesh);
    for (const std::string& warning : result.report.warnings()) {
      EXPECT_EQ(warning.find("inside out"), std::string::npos) << warning;
    }
  };
  expect_turned(box(kOrigin, 1), box(kOrigin, 1));
  expect_turned(box(kOrigin, -1), box(kOrigin, 1));
  expect_turned(all_of({box(kOrigin, 3), box(kAside, -1)}),
                all_of({box(kOrigin, 3), box(kAside, 1)}));
  const PolyMesh hollow = all_of({box(kOrigin, 4), box(kOrigin, -3), box(kOrigin, 1)});
  expect_turned(hollow, hollow);
  expect_turned(shapes::turned(hollow, [](Index) { return true; }), hollow);
  expect_turned(all_of({box(kOrigin, 4), box(kOrigin, -3), box(kOrigin, -1)}), hollow);
  expect_turned(all_of({box(kOrigin, -3), box(kOrigin, -1)}),
                all_of({box(kOrigin, 3), box(kOrigin, 1)}));
  // What lies beside, or inside in part, stays.
  expect_turned(all_of({box(kOrigin, -3), box(Vec3(3, 0.1, 0.2), 1)}),
                all_of({box(kOrigin, 3), box(Vec3(3, 0.1, 0.2), 1)}));
}

TEST(ClosedComponents, KeepTheirTextureWhereTheyAreTurned) {
  PolyMesh turned = box(kOrigin, -1);
  for (const Index v : turned.corners) {
    const Vec3& p = turned.positions[v];
    turned.attributes.texture.push_back({p.x() + 2 * p.z(), p.y()});
  }
  ImportOptions options;
  options.outwards = true;
  const TriMesh mesh = shapes::imported(turned, options).mesh;
  ASSERT_GT(shapes::volume(mesh), 0);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    const Vec3& p = mesh.positions[mesh.from(h)];
    EXPECT_NEAR(mesh.attributes.texture[h][0], p.x() + 2 * p.z(), 1e-12);
    EXPECT_NEAR(mesh.attributes.texture[h][1], p.y(), 1e-12);
  }
}

TEST(ClosedComponents, OpenAndFlatOnesAreNotJudged) {
  const PolyMesh sheet = shapes::grid(2, 2, [](double, double) { return 0.0; });
  const PolyMesh turned = shapes::turned(sheet, [](Index) { return true; });
  EXPECT_EQ(judge_closed_components(turned).count, 0);
  // Both sides of a sheet, joined at the rim and with inner vertices of their own.
  const TriMesh flat =
      shapes::imported(support::transformed(
                           shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                             Vec3(0, 1, 0), Vec3(0.4, 0.5, 0), Vec3(0.6, 0.5, 0)},
                                            {{0, 1, 4},
                                             {1, 2, 4},
                                             {2, 3, 4},
                                             {3, 0, 4},
                                             {1, 0, 5},
                                             {2, 1, 5},
                                             {3, 2, 5},
                                             {0, 3, 5}}),
                           support::oblique_rotation(), Vec3(1, 2, 3)))
          .mesh;
  const ClosedComponents closed = judge_closed_components(flat);
  EXPECT_EQ(closed.count, 1);
  EXPECT_EQ(closed.inside_out, 0);
}

TEST(ClosedComponents, ImportSaysHowManyAreInsideOut) {
  const auto warning_of = [](const PolyMesh& mesh) -> std::string {
    const ImportResult result = shapes::imported(mesh);
    for (const std::string& warning : result.report.warnings()) {
      if (warning.find("inside out") != std::string::npos) return warning;
    }
    return "";
  };
  const PolyMesh open = support::transformed(shapes::grid(2, 2, [](double, double) { return 0.0; }),
                                             Mat3::Identity(), Vec3(20, 0, 0));
  EXPECT_EQ(warning_of(all_of({box(kOrigin, 3), box(kOrigin, -1), open})), "");
  EXPECT_TRUE(warning_of(box(kOrigin, -1)).starts_with("the surface is inside out"));
  EXPECT_TRUE(warning_of(all_of({box(kOrigin, 3), box(kAside, -1), open}))
                  .starts_with("1 of 3 components are inside out"));
}

}  // namespace
}  // namespace strake
