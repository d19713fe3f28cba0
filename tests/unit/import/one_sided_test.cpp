#include "stages/import/one_sided.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/geometry/topology/topology.h"
#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

constexpr int kRows = 4;
constexpr double kNarrowest = 0.1;

/// A Moebius band that is narrowest at a third of its way, and four times as wide opposite.
PolyMesh moebius_band() {
  const int n = 60;
  PolyMesh band;
  for (int i = 0; i < n; ++i) {
    const double u = 2 * std::numbers::pi * i / n;
    const double width = kNarrowest * (2.5 - 1.5 * std::cos(u - 2 * std::numbers::pi / 3));
    for (int row = 0; row <= kRows; ++row) {
      const double w = width * (row - 0.5 * kRows) / kRows;
      const double r = 1 + w * std::cos(u / 2);
      band.positions.emplace_back(r * std::cos(u), r * std::sin(u), w * std::sin(u / 2));
    }
  }
  const auto at = [&](int i, int row) {
    return static_cast<Index>(i < n ? (kRows + 1) * i + row : kRows - row);
  };
  for (int i = 0; i < n; ++i) {
    for (int row = 0; row < kRows; ++row) {
      band.add_face(
          std::vector<Index>{at(i, row), at(i + 1, row), at(i + 1, row + 1), at(i, row + 1)});
    }
  }
  return band;
}

double boundary_length(const TriMesh& mesh) {
  double sum = 0;
  for (Index h = 0; h < mesh.halfedge_count(); ++h) {
    if (!mesh.is_boundary(h)) continue;
    sum += (mesh.positions[mesh.to(h)] - mesh.positions[mesh.from(h)]).norm();
  }
  return sum;
}

double cut_length(const PolyMesh& band) {
  const ImportResult result = shapes::imported(band, shapes::undivided());
  EXPECT_EQ(census(result.mesh).components, 1);
  EXPECT_GT(shapes::count(result.report, "repairs.non_orientable_cuts"), 0);
  double outline = 0;
  const PolyMesh whole = moebius_band();
  const auto place = [&](int i, int row) {
    return whole.positions[i < 60 ? 5 * i + row : 4 - row];
  };
  for (int i = 0; i < 60; ++i) {
    for (const int row : {0, kRows}) outline += (place(i + 1, row) - place(i, row)).norm();
  }
  return (boundary_length(result.mesh) - outline) / 2;
}

TEST(OneSided, IsCutWhereItIsNarrowInAnyOrderOfFaces) {
  double first = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    // Every third face the other way round, so that the input says nothing.
    const PolyMesh mixed = shapes::turned(moebius_band(), [](Index f) { return f % 3 == 0; });
    const double length = cut_length(support::permuted(mixed, seed).mesh);
    EXPECT_LT(length, 1.3 * kNarrowest) << seed;
    if (seed == 0) first = length;
    EXPECT_NEAR(length, first, 1e-9) << seed;
  }
}

}  // namespace
}  // namespace strake
