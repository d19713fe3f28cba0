#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numbers>

#include "common/core/error.h"
#include "common/geometry/density.h"
#include "tests/support/attributed.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;
using shapes::imported;

bool is_repaired(const ImportResult& result) { return !result.report.warnings().empty(); }

TEST(Repair, SoundMeshesStayAsTheyAre) {
  const PolyMesh torus = shapes::torus(9, 7);
  const ImportResult result = imported(torus);
  EXPECT_FALSE(is_repaired(result));
  EXPECT_EQ(result.mesh.vertex_count(), torus.vertex_count());
  EXPECT_EQ(result.mesh.face_count(), 2 * torus.face_count());
  EXPECT_EQ(count(result.report, "repairs.triangulated_faces"), torus.face_count());
  for (Index v = 0; v < result.mesh.vertex_count(); ++v) {
    EXPECT_EQ(result.mesh.positions[v], torus.positions[result.mesh.source_vertex[v]]);
  }
  for (Index f = 0; f < result.mesh.face_count(); ++f) {
    const auto polygon = torus.face(result.mesh.source_face[f]);
    for (const Index v : result.mesh.faces[f]) {
      EXPECT_EQ(std::count(polygon.begin(), polygon.end(), result.mesh.source_vertex[v]), 1);
    }
  }
}

TEST(Repair, UnweldedSoupBecomesTheClosedSurface) {
  for (const double jitter : {0.0, 1e-8}) {
    PolyMesh soup = shapes::unwelded(shapes::torus(16, 8));
    for (Index v = 0; v < soup.vertex_count(); ++v) {
      soup.positions[v] += jitter * Vec3(std::sin(v), std::cos(3 * v), std::sin(7 * v));
    }
    const ImportResult result = imported(soup);
    const Census counts = census(result.mesh);
    EXPECT_EQ(counts.components, 1);
    EXPECT_EQ(counts.boundary_loops, 0);
    EXPECT_EQ(counts.genus, 1);
    EXPECT_EQ(result.mesh.vertex_count(), 16 * 8);
    EXPECT_EQ(count(result.report, "repairs.welded_vertices"), soup.vertex_count() - 16 * 8);
    EXPECT_TRUE(is_repaired(result));
  }
}

TEST(Repair, ClosedPiecesThatTouchAreNotGlued) {
  // Two cubes that share the positions of a whole face, each with vertices of its own.
  const PolyMesh pair = support::together(shapes::cube(), shapes::cube(Vec3(1, 0, 0)));
  const ImportResult result = imported(pair);
  EXPECT_FALSE(is_repaired(result));
  EXPECT_EQ(census(result.mesh).components, 2);
  EXPECT_EQ(result.mesh.vertex_count(), 16);
}

TEST(Repair, OpenSheetsThatTouchInAPointAreNotGlued) {
  const PolyMesh sheet = shapes::grid(2, 2, [](double, double) { return 0.0; });
  PolyMesh other = sheet;
  for (Vec3& p : other.positions) p += Vec3(1, 1, 0);
  const ImportResult result = imported(support::together(sheet, other));
  EXPECT_FALSE(is_repaired(result));
  EXPECT_EQ(census(result.mesh).components, 2);
}

TEST(Repair, SeamAndPolesOfAParametricSphereClose) {
  // A grid over longitude and latitude: a seam of double vertices, poles of many vertices.
  PolyMesh mesh = shapes::grid(12, 6, [](double, double) { return 0.0; });
  for (Vec3& p : mesh.positions) {
    const double u = p.x() == 1 ? 0 : 2 * std::numbers::pi * p.x();
    const double r = p.y() == 0 || p.y() == 1 ? 0 : std::sin(std::numbers::pi * p.y());
    p = Vec3(r * std::cos(u), r * std::sin(u), -std::cos(std::numbers::pi * p.y()));
  }
  const TriMesh sphere = imported(mesh).mesh;
  const Census counts = census(sphere);
  EXPECT_EQ(counts.boundary_loops, 0);
  EXPECT_EQ(counts.euler_characteristic, 2);
  EXPECT_EQ(sphere.vertex_count(), 12 * 5 + 2);
}

TEST(Repair, DegenerateAndDuplicateFacesGo) {
  PolyMesh mesh = shapes::cube();
  mesh.add_face(std::vector<Index>{0, 2, 2});
  mesh.add_face(std::vector<Index>{0, 2, 3, 1});
  mesh.add_face(std::vector<Index>{1, 3, 2, 0});
  const ImportResult result = imported(mesh);
  EXPECT_EQ(count(result.report, "repairs.degenerate_faces"), 1);
  EXPECT_EQ(count(result.report, "repairs.duplicate_faces"), 4);
  EXPECT_EQ(result.mesh.face_count(), 12);
  EXPECT_EQ(census(result.mesh).euler_characteristic, 2);
}

TEST(Repair, DoubleSidedSheetBecomesOneSheet) {
  const PolyMesh sheet = shapes::grid(3, 3, [](double, double) { return 0.0; });
  PolyMesh both = shapes::turned(sheet, [](Index) { return true; });
  PolyMesh mesh = sheet;
  for (Index f = 0; f < both.face_count(); ++f) mesh.add_face(both.face(f));
  const TriMesh result = imported(mesh).mesh;
  EXPECT_EQ(result.face_count(), 2 * sheet.face_count());
  EXPECT_EQ(census(result).boundary_loops, 1);
  EXPECT_NEAR(shapes::area(result), 1, 1e-14);
}

TEST(Repair, WallBetweenSolidsThatShareAFaceGoes) {
  const PolyMesh pair =
      shapes::merged(support::together(shapes::cube(), shapes::cube(Vec3(1, 0, 0))));
  const ImportResult result = imported(pair);
  EXPECT_EQ(count(result.report, "repairs.duplicate_faces"), 2);
  EXPECT_EQ(count(result.report, "repairs.inner_faces"), 2);
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.euler_characteristic, 2);
  EXPECT_NEAR(shapes::volume(result.mesh), 2, 1e-14);
}

TEST(Repair, SolidsThatShareAnEdgeComeApartClosed) {
  const PolyMesh pair =
      shapes::merged(support::together(shapes::cube(), shapes::cube(Vec3(1, 1, 0))));
  ASSERT_EQ(pair.vertex_count(), 14);
  const ImportResult result = imported(pair);
  EXPECT_EQ(count(result.report, "repairs.non_manifold_edges"), 1);
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, 2);
  EXPECT_EQ(counts.boundary_loops, 0);
  EXPECT_EQ(result.mesh.vertex_count(), 16);
  EXPECT_NEAR(shapes::volume(result.mesh), 2, 1e-14);
}

TEST(Repair, SolidsThatShareAVertexComeApart) {
  const PolyMesh pair =
      shapes::merged(support::together(shapes::cube(), shapes::cube(Vec3(1, 1, 1))));
  ASSERT_EQ(pair.vertex_count(), 15);
  const ImportResult result = imported(pair);
  EXPECT_EQ(census(result.mesh).components, 2);
  EXPECT_EQ(result.mesh.vertex_count(), 16);
  EXPECT_EQ(count(result.report, "repairs.split_vertices"), 1);
}

TEST(Repair, SheetsThatCrossInAnEdgeRunOnFlat) {
  // Four half planes meet in the edge (0, 1): opposite ones belong together.
  const PolyMesh cross = shapes::polygons({Vec3(0, 0, 0), Vec3(0, 0, 1), Vec3(1, 0.1, 0),
                                           Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, -1, 0)},
                                          {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {1, 0, 5}});
  const TriMesh mesh =
      imported(cross, {.feature_angle_deg = 180, .longest_edge = percent(100)}).mesh;
  EXPECT_EQ(census(mesh).components, 2);
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (mesh.twin[h] == kNone) continue;
    const Index a = mesh.source_vertex[mesh.from(TriMesh::prev(h))];
    const Index b = mesh.source_vertex[mesh.from(TriMesh::prev(mesh.twin[h]))];
    EXPECT_EQ(std::min(a, b) == 2, std::max(a, b) == 3) << a << " " << b;
  }
}

TEST(Repair, TurnedFacesFollowTheMajority) {
  const PolyMesh torus = shapes::torus(12, 8);
  const double expected = shapes::volume(imported(torus).mesh);
  ASSERT_GT(expected, 0);
  const ImportResult few = imported(shapes::turned(torus, [](Index f) { return f % 7 == 3; }));
  EXPECT_NEAR(shapes::volume(few.mesh), expected, 1e-12);
  EXPECT_EQ(count(few.report, "repairs.flipped_faces"), 2 * ((96 - 4) / 7 + 1));
  // Evenly divided: outwards.
  const ImportResult half = imported(shapes::turned(torus, [](Index f) { return f % 9 >= 4; }));
  EXPECT_NEAR(shapes::volume(half.mesh), expected, 1e-12);
}

TEST(Repair, OpenPiecesWithoutAClearMajorityLookOutwards) {
  // Three of five faces of three quarters of a torus look inwards.
  const PolyMesh open = shapes::filtered(shapes::torus(12, 8), [](Index f) { return f >= 24; });
  const double expected = shapes::volume(imported(open).mesh);
  ASSERT_GT(expected, 0);
  const ImportResult mixed = imported(shapes::turned(open, [](Index f) { return f % 5 < 3; }));
  EXPECT_NEAR(shapes::volume(mixed.mesh), expected, 1e-12);
}

TEST(Repair, ConsistentlyInsideOutIsKept) {
  const ImportResult result = imported(shapes::turned(shapes::cube(), [](Index) { return true; }));
  EXPECT_EQ(count(result.report, "repairs.flipped_faces"), 0);
  EXPECT_NEAR(shapes::volume(result.mesh), -1, 1e-14);
}

TEST(Repair, ClosedSurfacesThatLookInwardsAreNamed) {
  const auto is_named = [](const PolyMesh& mesh) {
    return std::ranges::any_of(imported(mesh).report.warnings(), [](const std::string& warning) {
      return warning.find("inside out") != std::string::npos;
    });
  };
  const auto all = [](Index) { return true; };
  EXPECT_FALSE(is_named(shapes::torus(9, 7)));
  EXPECT_TRUE(is_named(shapes::turned(shapes::torus(9, 7), all)));
  const PolyMesh open = shapes::grid(4, 4, [](double, double) { return 0.0; });
  EXPECT_FALSE(is_named(open));
  EXPECT_FALSE(is_named(shapes::turned(open, all)));
}

TEST(Repair, MoebiusBandIsCutOpen) {
  const int n = 40;
  PolyMesh band;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    for (const double w : {-0.3, 0.0, 0.3}) {
      const double r = 1 + w * std::cos(u / 2);
      band.positions.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int k = 0; k < 2; ++k) {
      const int j = (i + 1) % n;
      const auto at = [&](int row) { return static_cast<Index>(3 * j + (j == 0 ? 2 - row : row)); };
      band.add_face(std::vector<Index>{3 * i + k, at(k), at(k + 1), 3 * i + k + 1});
    }
  }
  const ImportResult result = imported(band);
  // Where its faces run the same way, so that none is to be turned over.
  EXPECT_EQ(count(result.report, "repairs.non_orientable_cuts"), 2);
  EXPECT_EQ(count(result.report, "repairs.flipped_faces"), 0);
  ASSERT_FALSE(result.report.warnings().empty());
  EXPECT_NE(result.report.warnings()[0].find("only one side"), std::string::npos);
  const Census counts = census(result.mesh);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.boundary_loops, 1);
  EXPECT_EQ(counts.euler_characteristic, 1);
}

TEST(Repair, UnreferencedVerticesCountForNothing) {
  PolyMesh mesh = shapes::cube();
  mesh.positions.emplace_back(1e9, 0, 0);
  mesh.positions.emplace_back(std::nan(""), 0, 0);
  const ImportResult result = imported(mesh);
  EXPECT_EQ(result.mesh.vertex_count(), 8);
  EXPECT_EQ(count(result.report, "repairs.unreferenced_vertices"), 2);
  EXPECT_DOUBLE_EQ(result.mesh.diagonal, std::sqrt(3.0));
}

TEST(Repair, FarFromTheOriginNoDigitIsLost) {
  const Vec3 shift(1e6 + 0.1, -3e6, 7);
  const PolyMesh far = shapes::cube(shift);
  const TriMesh mesh = imported(far).mesh;
  EXPECT_GT(mesh.origin.norm(), 0);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    EXPECT_LT(mesh.positions[v].norm(), 2 * mesh.diagonal);
    EXPECT_EQ(mesh.positions[v] + mesh.origin, far.positions[mesh.source_vertex[v]]);
  }
  EXPECT_EQ(imported(shapes::cube()).mesh.origin, Vec3(Vec3::Zero()));
}

TEST(Repair, NothingUsableIsRefused) {
  SilentObserver observer;
  const auto refused = [&](const PolyMesh& mesh) {
    EXPECT_THROW(import_mesh(mesh, {}, observer), InputError);
  };
  refused({});
  const std::vector<std::vector<Index>> faces = {{0, 1, 2}, {0, 2, 3}};
  refused(shapes::polygons(std::vector<Vec3>(4, Vec3(1, 2, 3)), faces));
  refused(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 1, 1), Vec3(2, 2, 2), Vec3(5, 5, 5)}, faces));
  refused(shapes::polygons(std::vector<Vec3>(4, Vec3(std::nan(""), 0, 0)), faces));
  refused(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 7}}));
  refused(shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}, {{0, 1, 1}}));
  const double huge = std::numeric_limits<double>::max();
  refused(shapes::polygons({Vec3(-huge, 0, 0), Vec3(huge, 0, 0), Vec3(0, huge, 0)}, {{0, 1, 2}}));
}

TEST(Repair, StrictRefusesWithAListAndAcceptsSoundMeshes) {
  const ImportOptions strict{.strict = true};
  EXPECT_NO_THROW(imported(shapes::torus(5, 5), strict));
  PolyMesh broken = shapes::turned(shapes::cube(), [](Index f) { return f == 2; });
  broken.add_face(std::vector<Index>{0, 1, 1});
  try {
    imported(broken, strict);
    FAIL() << "the mesh needs repairs";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("turned over"), std::string::npos) << message;
    EXPECT_NE(message.find("a vertex twice"), std::string::npos) << message;
  }
}

/// Two slabs of four cubes on two cubes that touch along an edge: there four sheets meet, and the
/// ends of the edge belong to all.
PolyMesh slabs_on_diagonal_cubes() {
  PolyMesh faces;
  const auto is_full = [](int x, int y, int z) {
    const bool is_inside = x >= 0 && x < 2 && y >= 0 && y < 2 && z >= 0 && z < 3;
    return is_inside && (z != 1 || x == y);
  };
  const std::array<Vec3, 6> towards = {-Vec3::UnitZ(), Vec3::UnitZ(),  -Vec3::UnitY(),
                                       Vec3::UnitY(),  -Vec3::UnitX(), Vec3::UnitX()};
  for (int i = 0; i < 12; ++i) {
    const Vec3 place(i & 1, (i >> 1) & 1, i >> 2);
    const PolyMesh cube = shapes::cube(place);
    for (Index f = 0; f < cube.face_count(); ++f) {
      const Vec3 beyond = place + towards[f];
      if (!is_full(i & 1, (i >> 1) & 1, i >> 2) ||
          is_full(int(beyond.x()), int(beyond.y()), int(beyond.z()))) {
        continue;
      }
      const Index first = faces.vertex_count();
      for (const Index v : cube.face(f)) faces.positions.push_back(cube.positions[v]);
      faces.add_face(std::array<Index, 4>{first, first + 1, first + 2, first + 3});
    }
  }
  return shapes::merged(faces);
}

TEST(Repair, InsertedVerticesTakeColoursAndDensityFromAround) {
  PolyMesh input = slabs_on_diagonal_cubes();
  support::colour_linearly(input);
  const ImportResult result = imported(input);
  const std::vector<Index>& source = result.mesh.source_vertex;
  ASSERT_GT(std::ranges::count(source, kNone), 0);
  DensityField density;
  for (const Vec3& p : input.positions) density.value.push_back(1 + p.z());
  const std::vector<double> at_wedge = density_at_wedges(result.mesh, density);
  for (Index w = 0; w < result.mesh.wedge_count(); ++w) {
    const Index v = result.mesh.wedge_vertex[w];
    const double z = result.mesh.positions[v].z() + result.mesh.origin.z();
    if (source[v] != kNone) {
      EXPECT_DOUBLE_EQ(at_wedge[w], 1 + z);
      continue;
    }
    EXPECT_GT(at_wedge[w], 1);
    EXPECT_LT(at_wedge[w], 4);
    EXPECT_GT(result.mesh.attributes.colour[v][3], 0);
  }
}

TEST(Repair, SameInputSameResult) {
  const PolyMesh mesh = shapes::unwelded(shapes::torus(20, 10));
  EXPECT_EQ(imported(mesh).mesh.id, imported(mesh).mesh.id);
}

TEST(Repair, TrianglesWithoutAreaThatHoldTheSurfaceTogetherStay) {
  // A square whose upper half hangs on the lower one by a triangle of no height.
  const PolyMesh mesh = shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                          Vec3(1, 1, 0), Vec3(0.5, 1, 0), Vec3(0.5, 2, 0)},
                                         {{0, 1, 3, 2}, {2, 3, 4}, {2, 4, 5}, {4, 3, 5}});
  const TriMesh result = imported(mesh).mesh;
  const Census counts = census(result);
  EXPECT_EQ(counts.components, 1);
  EXPECT_EQ(counts.boundary_loops, 1);
  EXPECT_EQ(counts.euler_characteristic, 1);
  EXPECT_NEAR(shapes::area(result), 1.5, 1e-14);
}

TEST(Repair, FlatTriangleIsFlippedAway) {
  // Vertex 4 lies on the edge (2, 3): the triangle between has no area.
  const PolyMesh mesh = shapes::polygons({Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0),
                                          Vec3(1, 1, 0), Vec3(0.5, 1, 0), Vec3(0.5, 2, 0)},
                                         {{0, 1, 3}, {0, 3, 2}, {2, 3, 4}, {2, 4, 5}, {4, 3, 5}});
  const ImportResult result = imported(mesh);
  EXPECT_EQ(count(result.report, "repairs.flipped_edges"), 1);
  EXPECT_EQ(result.mesh.face_count(), 5);
  EXPECT_EQ(census(result.mesh).euler_characteristic, 1);
  EXPECT_NEAR(shapes::area(result.mesh), 1.5, 1e-14);
  for (const auto& [a, b, c] : result.mesh.faces) {
    const Vec3& p = result.mesh.positions[a];
    EXPECT_GT((result.mesh.positions[b] - p).cross(result.mesh.positions[c] - p).z(), 0.1);
  }
}

TEST(Repair, EdgesOfNoLengthCollapse) {
  PolyMesh mesh = shapes::torus(12, 9);
  mesh.positions[1] = Vec3(mesh.positions[0]);
  mesh.positions[40] = Vec3(mesh.positions[41]);
  const ImportResult result = imported(mesh);
  EXPECT_EQ(count(result.report, "repairs.collapsed_edges"), 2);
  EXPECT_EQ(result.mesh.vertex_count(), mesh.vertex_count() - 2);
  EXPECT_EQ(result.mesh.face_count(), 2 * mesh.face_count() - 4);
  EXPECT_EQ(census(result.mesh).genus, 1);
}

TEST(Repair, NoEdgeCollapsesWhereATunnelWouldClose) {
  // A torus three quads around: two corners of one of its triangular rings coincide. Without the
  // link condition the ring would be pinched to a point.
  PolyMesh mesh = shapes::torus(3, 9);
  mesh.positions[1] = Vec3(mesh.positions[0]);
  const ImportResult result = imported(mesh);
  EXPECT_EQ(result.mesh.vertex_count(), mesh.vertex_count());
  EXPECT_EQ(census(result.mesh).genus, 1);
}

TEST(Repair, PiecesWithoutAreaGo) {
  // A triangle with two corners in one place, one with all three, and a needle of two triangles
  // along a line: nothing can be collapsed there, as nothing would be left.
  const auto piece = [](const Vec3& a, const Vec3& b, const Vec3& c) {
    return shapes::polygons({a, b, c}, {{0, 1, 2}});
  };
  const Vec3 at(0.3, 0.3, 2);
  PolyMesh mesh = support::together(shapes::cube(), piece(at, at, Vec3(1, 1, 2)));
  mesh = support::together(mesh, piece(at, at, at));
  mesh = support::together(
      mesh, shapes::polygons({at, at + Vec3(1, 0, 0), at + Vec3(3, 0, 0), at + Vec3(2, 0, 0)},
                             {{0, 1, 2}, {0, 2, 3}}));
  const ImportResult result = imported(mesh);
  EXPECT_EQ(count(result.report, "repairs.faces_without_area") +
                count(result.report, "repairs.degenerate_faces"),
            4);
  EXPECT_GE(count(result.report, "repairs.faces_without_area"), 2);
  EXPECT_EQ(census(result.mesh).components, 1);
  EXPECT_NEAR(shapes::area(result.mesh), 6, 1e-14);
}

/// `count` cubes in a row, each sharing a face with the next.
PolyMesh row_of_cubes(int count) {
  PolyMesh row = shapes::cube();
  for (int i = 1; i < count; ++i) row = support::together(row, shapes::cube(Vec3(i, 0, 0)));
  return shapes::merged(row);
}

TEST(Repair, RemovesNoMoreThanIsAllowed) {
  // n cubes have 4 n + 2 squares outside and n - 1 between them: the share of the walls is
  // (n - 1) / (5 n + 1), 9.1 % for two, 12.5 % for three.
  EXPECT_EQ(imported(row_of_cubes(2)).mesh.face_count(), 2 * 10);
  try {
    imported(row_of_cubes(3));
    FAIL() << "12.5 % of the surface are walls";
  } catch (const InputError& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("12.5 %"), std::string::npos) << message;
    EXPECT_NE(message.find("--most-removed 13"), std::string::npos) << message;
    EXPECT_NE(message.find("walls between touching solids: 4"), std::string::npos) << message;
  }
  EXPECT_EQ(imported(row_of_cubes(3), {.most_removed_percent = 13, .longest_edge = percent(100)})
                .mesh.face_count(),
            2 * 14);
  EXPECT_THROW(imported(row_of_cubes(2), {.most_removed_percent = 0}), InputError);
}

TEST(Repair, WhatIsThereTwiceDoesNotCountAsRemoved) {
  PolyMesh mesh = shapes::torus(9, 7);
  const PolyMesh turned = shapes::turned(mesh, [](Index) { return true; });
  for (int copy = 0; copy < 5; ++copy) {
    for (Index f = 0; f < turned.face_count(); ++f) mesh.add_face(turned.face(f));
  }
  const ImportOptions careful{.most_removed_percent = 0};
  EXPECT_NO_THROW(imported(shapes::torus(9, 7), careful));
  EXPECT_NEAR(shapes::area(imported(mesh, {.most_removed_percent = 1e-6}).mesh),
              shapes::area(imported(shapes::torus(9, 7)).mesh), 1e-12);
}

TEST(Repair, SizesWhoseProductsAreNoNumbersAreRefused) {
  for (const double size : {1e-29, 1e-3, 1e59}) {
    PolyMesh cube = shapes::cube();
    for (Vec3& p : cube.positions) p *= size;
    EXPECT_NEAR(shapes::area(imported(cube).mesh) / (6 * size * size), 1, 1e-14);
  }
  for (const double size : {1e-31, 1e-60, 1e61, 1e100}) {
    PolyMesh cube = shapes::cube();
    for (Vec3& p : cube.positions) p *= size;
    EXPECT_THROW(imported(cube), InputError);
  }
}

}  // namespace
}  // namespace strake
