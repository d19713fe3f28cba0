#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

using shapes::count;
using shapes::imported;

/// A quarter of the faces each with vertices of their own, all moved by up to `shift` of the
/// diagonal of the torus, 3.
PolyMesh torn_torus(double shift) {
  const PolyMesh torus = shapes::torus(24, 12);
  PolyMesh torn;
  for (int part = 0; part < 4; ++part) {
    torn = support::together(torn, shapes::filtered(torus, [&](Index f) {
                               return 2 * (f % 24 / 12) + f / 24 / 6 == part;
                             }));
  }
  for (Index v = 0; v < torn.vertex_count(); ++v) {
    torn.positions[v] +=
        3 * shift / std::sqrt(3.0) * Vec3(std::sin(5.0 * v), std::cos(3.0 * v), std::sin(7.0 * v));
  }
  return torn;
}

TEST(Sew, PatchesThatMissEachOtherByLittleAreSewn) {
  // Vertices of neighbours are up to twice the shift apart.
  for (const double shift : {1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 0.9e-4}) {
    const ImportResult result = imported(torn_torus(shift));
    const Census counts = census(result.mesh);
    EXPECT_EQ(counts.components, 1) << shift;
    EXPECT_EQ(counts.boundary_loops, 0) << shift;
    EXPECT_EQ(counts.genus, 1) << shift;
    EXPECT_EQ(result.mesh.vertex_count(), 24 * 12) << shift;
    EXPECT_FALSE(result.report.warnings().empty());
    EXPECT_EQ(count(result.report, "borders.near_edges"), 0);
  }
  // A gap twenty times as wide is not closed, and only that far from its edges no crack.
  const ImportResult wide = imported(torn_torus(2e-3));
  EXPECT_EQ(census(wide.mesh).components, 4);
}

TEST(Sew, LooseTrianglesThatMissEachOtherByLittleAreSewn) {
  PolyMesh soup = shapes::unwelded(shapes::torus(16, 8));
  for (Index v = 0; v < soup.vertex_count(); ++v) {
    soup.positions[v] += 3e-5 * Vec3(std::sin(5.0 * v), std::cos(3.0 * v), std::sin(7.0 * v));
  }
  const ImportResult result = imported(soup);
  EXPECT_EQ(census(result.mesh).boundary_loops, 0);
  EXPECT_EQ(result.mesh.vertex_count(), 16 * 8);
  EXPECT_EQ(count(result.report, "repairs.sewn_vertices"), soup.vertex_count() - 16 * 8);
}

TEST(Sew, PatchesThatAreTurnedOverAreSewn) {
  const ImportResult result =
      imported(shapes::turned(torn_torus(1e-5), [](Index f) { return f < 72; }));
  EXPECT_EQ(census(result.mesh).boundary_loops, 0);
  EXPECT_GT(count(result.report, "repairs.flipped_faces"), 0);
}

TEST(Sew, SheetsOfAThinShellStayApart) {
  const auto wave = [](double x, double y) { return 0.3 * std::sin(3 * x) * y; };
  const PolyMesh outer = shapes::grid(12, 12, wave);
  PolyMesh inner = shapes::turned(outer, [](Index) { return true; });
  for (const double thickness : {1e-5, 1e-4, 1e-3}) {
    PolyMesh moved = inner;
    for (Index v = 0; v < moved.vertex_count(); ++v) {
      moved.positions[v] += thickness * Vec3(0.1 * std::sin(5.0 * v), 0.1 * std::cos(3.0 * v), -1);
    }
    const ImportResult result = imported(support::together(outer, moved));
    EXPECT_TRUE(result.report.warnings().empty()) << result.report.warnings().front();
    EXPECT_EQ(census(result.mesh).components, 2);
    EXPECT_EQ(census(result.mesh).boundary_loops, 2);
  }
}

/// A square of 12 x 12 cells cut open along its middle, 6 edges long; `moved(i)` is added to the
/// vertices of the lower bank, of number i along the middle, from 4 to 8: the ends are shared.
template <typename Moved>
PolyMesh slit_square(const Moved& moved) {
  constexpr int kCells = 12;
  PolyMesh mesh = shapes::grid(kCells, kCells, [](double, double) { return 0.0; });
  const Index first = kCells / 2 * (kCells + 1);
  std::vector<Index> copy(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) copy[v] = v;
  for (Index i = kCells / 3; i <= 2 * kCells / 3; ++i) {
    const Vec3 at = mesh.positions[first + i];
    copy[first + i] = mesh.vertex_count();
    mesh.positions.push_back(at + moved(i));
  }
  PolyMesh cut;
  cut.positions = mesh.positions;
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face(mesh.face(f).begin(), mesh.face(f).end());
    const bool is_below = f / kCells < kCells / 2;
    for (Index& v : face) v = is_below ? copy[v] : v;
    cut.add_face(face);
  }
  return cut;
}

TEST(Sew, SlitsStayAndAreNamed) {
  const auto slit = slit_square([](Index) { return Vec3(0, -1e-4, 0); });
  const ImportResult result = imported(slit);
  EXPECT_EQ(count(result.report, "repairs.sewn_vertices"), 0);
  EXPECT_EQ(census(result.mesh).boundary_loops, 2);
  EXPECT_EQ(count(result.report, "borders.near_edges"), 2 * 6);
  // One whose banks cross each other is none.
  const auto crack = slit_square([](Index i) { return Vec3(0, i % 2 == 0 ? 1e-4 : -1e-4, 0); });
  EXPECT_EQ(census(imported(crack).mesh).boundary_loops, 1);
}

TEST(Sew, NoneOfThreeSheetsThatMeetIsPreferred) {
  // Three leaves along the z axis, none of them nearer to one of the others by far.
  PolyMesh leaves;
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    PolyMesh leaf = shapes::grid(4, 4, [](double, double) { return 0.0; });
    for (Vec3& p : leaf.positions) {
      const double r = p.x() + 1e-5;
      p = Vec3(r * std::cos(angle), r * std::sin(angle), p.y());
    }
    leaves = support::together(leaves, leaf);
  }
  const ImportResult result = imported(leaves);
  EXPECT_EQ(census(result.mesh).components, 3);
  EXPECT_EQ(count(result.report, "borders.near_edges"), 12);
}

TEST(Sew, BordersThatAreDividedDifferentlyAndTooFarApartAreNamed) {
  // Squares beside each other with 8 and 5 edges along a side, 0.03 % of the diagonal apart: the
  // middle of every one of them lies beside the other side.
  PolyMesh other = shapes::grid(5, 5, [](double, double) { return 0.0; });
  for (Vec3& p : other.positions) p += Vec3(1 + 7e-4, 0, 0);
  const ImportResult result =
      imported(support::together(shapes::grid(8, 8, [](double, double) { return 0.0; }), other));
  EXPECT_EQ(count(result.report, "borders.near_edges"), 8 + 5);
  EXPECT_FALSE(result.report.warnings().empty());
  EXPECT_EQ(count(imported(other).report, "borders.near_edges"), 0);
}

/// A square of 4 x 4 cells cut open from the middle of its lower side, `deep` edges long, by 5e-4.
PolyMesh notched_square(Index deep) {
  constexpr Index kCells = 4;
  const PolyMesh mesh = shapes::grid(kCells, kCells, [](double, double) { return 0.0; });
  PolyMesh cut;
  cut.positions = mesh.positions;
  std::vector<Index> copy(mesh.positions.size());
  for (Index v = 0; v < mesh.vertex_count(); ++v) copy[v] = v;
  for (Index j = 0; j < deep; ++j) {
    const Index v = j * (kCells + 1) + kCells / 2;
    copy[v] = cut.vertex_count();
    cut.positions.push_back(mesh.positions[v] - Vec3(5e-4, 0, 0));
  }
  for (Index f = 0; f < mesh.face_count(); ++f) {
    std::vector<Index> face(mesh.face(f).begin(), mesh.face(f).end());
    const bool is_left = f % kCells < kCells / 2;
    for (Index& v : face) v = is_left ? copy[v] : v;
    cut.add_face(face);
  }
  return cut;
}

std::string warning_of_cracks(const ImportResult& result) {
  for (const std::string& warning : result.report.warnings()) {
    if (warning.find("cracks") != std::string::npos) return warning;
  }
  return "";
}

TEST(Sew, ANotchOfTheOutlineIsNoCrack) {
  const ImportResult notch = imported(notched_square(1));
  EXPECT_EQ(count(notch.report, "borders.near_edges"), 0);
  EXPECT_EQ(warning_of_cracks(notch), "");
  // One that goes on is.
  EXPECT_EQ(count(imported(notched_square(2)).report, "borders.near_edges"), 4);
}

TEST(Sew, ASingleEdgeIsNamedInTheSingular) {
  // Two triangles beside each other: the short side of one lies along the middle of the other's.
  const PolyMesh mesh = shapes::polygons(
      {{0, 0, 0}, {8, 0, 0}, {4, 5, 0}, {2, -1e-3, 0}, {3, -2, 0}, {3.2, -1e-3, 0}},
      {{0, 1, 2}, {3, 4, 5}});
  const ImportResult result = imported(mesh);
  ASSERT_EQ(count(result.report, "borders.near_edges"), 1);
  EXPECT_EQ(warning_of_cracks(result).substr(0, 19), "1 border edge lies ");
}

}  // namespace
}  // namespace strake
