#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <variant>

#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "strake/chain/remesh.h"
#include "tests/unit/chain/results.h"

namespace strake {
namespace {

PolyMesh sample(SampleKind kind, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  return make_sample(kind, options);
}

RemeshResult remeshed(const PolyMesh& mesh, std::int64_t vertices, double ratio) {
  RemeshOptions options;
  options.trace.vertices = vertices;
  options.working_ratio = ratio;
  return remesh({mesh, {}, {}, {}}, options);
}

bool has_run(const RemeshResult& result, const std::string& stage) {
  return std::ranges::any_of(result.reports,
                             [&](const auto& entry) { return entry.first == stage; });
}

TEST(WorkingMesh, IsMadeWhereTheInputIsMuchFinerThanTheResult) {
  const PolyMesh mesh = sample(SampleKind::torus, 30000);  // 15,000 vertices
  EXPECT_TRUE(has_run(remeshed(mesh, 300, 10), "coarsen"));
  EXPECT_TRUE(has_run(remeshed(mesh, 300, 10), "lift"));
  EXPECT_FALSE(has_run(remeshed(mesh, 1000, 10), "coarsen"));
  EXPECT_FALSE(has_run(remeshed(mesh, 300, 0), "coarsen"));
}

// What is worked on changes little of what comes out: it is measured against the input.
TEST(WorkingMesh, ResultsAreAsGoodAsThoseOfTheInput) {
  for (const SampleKind kind : {SampleKind::torus, SampleKind::ellipsoid, SampleKind::part}) {
    const PolyMesh mesh = sample(kind, 40000);
    const RemeshResult coarser = remeshed(mesh, 600, 10);
    const RemeshResult direct = remeshed(mesh, 600, 0);
    ASSERT_TRUE(has_run(coarser, "lift"));
    EXPECT_EQ(coarser.quads.mesh_id, coarser.mesh.id);
    EXPECT_NEAR(coarser.quads.mesh.vertex_count(), 600, 30);
    const PolyTopology topology = analyse(coarser.quads.mesh);
    EXPECT_TRUE(topology.is_oriented_manifold()) << topology.defects();
    EXPECT_EQ(topology.genus, analyse(direct.quads.mesh).genus);
    // On the part other seeds of lines alone make as much of a difference.
    const double most = kind == SampleKind::part ? 1.6 : 1.2;
    EXPECT_LT(measure_of(coarser, "distance.rms"), most * measure_of(direct, "distance.rms"));
    if (kind != SampleKind::part) continue;
    EXPECT_NEAR(measure_of(coarser, "features.kept_share"),
                measure_of(direct, "features.kept_share"), 0.05);
  }
}

TEST(WorkingMesh, GuidesNeedTheInput) {
  const PolyMesh mesh = sample(SampleKind::torus, 30000);
  RemeshOptions options;
  options.trace.vertices = 300;
  GuideLines guides;
  guides.lines.emplace_back();
  for (int i = 0; i <= 20; ++i) {
    const double angle = 0.1 * i;
    guides.lines.back().emplace_back(1.4 * std::cos(angle), 1.4 * std::sin(angle), 0);
  }
  EXPECT_FALSE(has_run(remesh({mesh, {}, guides, {}}, options), "coarsen"));
}

}  // namespace
}  // namespace strake
