#include "stages/import/listed_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/mesh_support.h"
#include "tests/unit/import/shapes.h"

namespace strake {
namespace {

constexpr Index kSide = 10;

/// Two sheets side by side, with vertices of their own: those of the second one begin at 121, and
/// its side is a hair off.
PolyMesh two_sheets() {
  PolyMesh mesh = shapes::grid(kSide, kSide, [](double, double) { return 0.0; });
  const PolyMesh other = mesh;
  const Index first = mesh.vertex_count();
  for (const Vec3& p : other.positions) mesh.positions.push_back(p + Vec3(1 + 3e-10, 0, 0));
  for (Index f = 0; f < other.face_count(); ++f) {
    std::vector<Index> face;
    for (const Index v : other.face(f)) face.push_back(first + v);
    mesh.add_face(face);
  }
  return mesh;
}

TEST(ListedEdges, AreNamedByEitherOfTwoVerticesThatAreJoined) {
  const PolyMesh mesh = two_sheets();
  SilentObserver observer;
  for (const Index first : {kSide, (kSide + 1) * (kSide + 1)}) {
    EdgeList list{{}, "list"};
    for (Index j = 0; j < kSide; ++j) {
      list.edges.push_back({first + (kSide + 1) * j, first + (kSide + 1) * (j + 1), j + 1});
    }
    const ImportResult result = import_mesh(mesh, shapes::undivided(), observer, &list);
    EXPECT_EQ(shapes::count(result.report, "repairs.welded_vertices"), kSide + 1);
    EXPECT_EQ(shapes::count(result.report, "features.listed_edges"), kSide) << first;
  }
}

/// A fold that is no crease by its angle.
TEST(ListedEdges, AreHeldWhereNoiseIsTakenOff) {
  const PolyMesh fold =
      shapes::grid(2 * kSide, kSide, [](double x, double) { return -0.1 * std::abs(x - 0.5); });
  EdgeList list{{}, "list"};
  for (Index j = 0; j < kSide; ++j) {
    const Index v = j * (2 * kSide + 1) + kSide;
    list.edges.push_back({v, v + 2 * kSide + 1, j + 1});
  }
  ImportOptions options = shapes::undivided();
  options.denoise = 20;
  SilentObserver observer;
  const auto lowered = [&](const EdgeList* listed) {
    const TriMesh mesh = import_mesh(fold, options, observer, listed).mesh;
    double most = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const Vec3& before = fold.positions[mesh.source_vertex[v]];
      if (std::abs(before.x() - 0.5) > 1e-9 || before.y() < 0.2 || before.y() > 0.8) continue;
      most = std::max(most, std::abs((mesh.positions[v] + mesh.origin - before).z()));
    }
    return most;
  };
  EXPECT_LT(lowered(&list), 1e-9);
  EXPECT_GT(lowered(nullptr), 1e-4);
}

}  // namespace
}  // namespace strake
