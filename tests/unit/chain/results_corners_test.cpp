#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/samples/samples.h"
#include "strake/chain/remesh.h"
#include "tests/support/cones.h"
#include "tests/unit/chain/results.h"

namespace strake {
namespace {

// Lines run together around the tip of a cone and end, and their cells cut it off. The second one
// has twenty times the vertices wanted, so lines are traced on a coarser mesh.
TEST(Remesh, ConesKeepTheirTips) {
  RemeshOptions counted;
  counted.trace.vertices = 400;
  RemeshOptions within;
  within.trace.tolerance = percent(0.3);
  for (const PolyMesh& mesh : {support::cone(60, 20, 2), support::cone(120, 80, 1)}) {
    for (RemeshOptions* options : {&counted, &within}) {
      options->measure = false;
      const PolyMesh result = remesh({mesh, {}, {}, {}}, *options).quads.mesh;
      EXPECT_EQ(std::ranges::count(result.positions, mesh.positions[0]), 1)
          << mesh.vertex_count() << (options == &within ? " within" : " counted");
      EXPECT_EQ(crossings(result), 0u);
    }
  }
}

// As modelling programs make it: a fan of triangles around the tip, whose one vertex has no
// direction, and another one around the middle of the base.
TEST(Remesh, AConeOfTwoFansIsRound) {
  for (const int sides : {32, 48, 100}) {
    PolyMesh mesh;
    mesh.positions = {Vec3(0, 0, 2), Vec3(0, 0, 0)};
    for (int i = 0; i < sides; ++i) {
      const double angle = 2 * M_PI * i / sides;
      mesh.positions.emplace_back(std::cos(angle), std::sin(angle), 0);
    }
    for (Index i = 0; i < sides; ++i) {
      const Index next = (i + 1) % sides;
      mesh.add_face(std::array<Index, 3>{0, 2 + i, 2 + next});
      mesh.add_face(std::array<Index, 3>{1, 2 + next, 2 + i});
    }
    const RemeshResult result = remesh({mesh, {}, {}, {}});
    EXPECT_LT(largest_distance(result), 1e-2 * result.mesh.diagonal) << sides;
  }
}

/// A barrel of `sides` sides: rings of planar quads, and a polygon at either end.
PolyMesh faceted_barrel(int sides) {
  PolyMesh mesh;
  const std::array<Vec2, 5> section = {Vec2(0.7, -1), Vec2(0.93, -0.5), Vec2(1, 0), Vec2(0.93, 0.5),
                                       Vec2(0.7, 1)};
  for (const Vec2& at : section) {
    for (int i = 0; i < sides; ++i) {
      const double turn = 2 * M_PI * i / sides;
      mesh.positions.emplace_back(at.x() * std::cos(turn), at.x() * std::sin(turn), at.y());
    }
  }
  std::vector<Index> bottom;
  std::vector<Index> top;
  for (Index i = 0; i < sides; ++i) {
    const Index next = (i + 1) % sides;
    for (Index ring = 0; ring < 4 * sides; ring += sides) {
      mesh.add_face(
          std::array<Index, 4>{ring + i, ring + next, ring + sides + next, ring + sides + i});
    }
    bottom.push_back(sides - 1 - i);
    top.push_back(4 * sides + i);
  }
  mesh.add_face(bottom);
  mesh.add_face(top);
  return mesh;
}

// Lines of curvature ran askew over the facets, and cells cut their edges: 2 % of the diagonal off.
TEST(Remesh, FacetsOfACoarseMeshStayWhereThereIsRoom) {
  const PolyMesh mesh = faceted_barrel(12);
  const auto largest = [&](std::int64_t vertices, double angle) {
    RemeshOptions options;
    options.trace.vertices = vertices;
    options.import.feature_angle_deg = angle;
    options.measure = false;
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
    EXPECT_EQ(crossings(result.quads.mesh), 0u) << vertices;
    return measure_cells({result.mesh, result.quads}).largest / result.mesh.diagonal;
  };
  const double many = largest(240, 40);
  EXPECT_LT(many, 1e-4);
  // What a user says of features holds.
  EXPECT_GT(largest(240, 50), 10 * many);
}

/// A plate with thin fins, as a comb that is drawn out.
PolyMesh heat_sink(int fins) {
  std::vector<Vec2> outline = {{0, 0}, {4.0 * fins - 3, 0}};
  for (int fin = fins - 1; fin >= 0; --fin) {
    const double x = 4.0 * fin;
    outline.insert(outline.end(), {{x + 1, 20}, {x, 20}});
    if (fin > 0) outline.insert(outline.end(), {{x, 4}, {x - 3, 4}});
  }
  PolyMesh mesh;
  const auto n = static_cast<Index>(outline.size());
  for (const double z : {0.0, 40.0}) {
    for (const Vec2& p : outline) mesh.positions.emplace_back(p.x(), p.y(), z);
  }
  std::vector<Index> front;
  std::vector<Index> back;
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    mesh.add_face(std::array<Index, 4>{i, next, n + next, n + i});
    back.push_back(n - 1 - i);
    front.push_back(n + i);
  }
  mesh.add_face(back);
  mesh.add_face(front);
  return mesh;
}

std::size_t corners_without_vertex(const PolyMesh& result, const PolyMesh& input) {
  return std::ranges::count_if(input.positions, [&](const Vec3& corner) {
    return std::ranges::none_of(result.positions,
                                [&](const Vec3& p) { return (p - corner).norm() < 1e-6; });
  });
}

// Fins are an eighth as thick as cells are wide. With corners merged like other vertices that are
// close the result was 2 % of the diagonal off.
TEST(Remesh, CornersOfThinFinsStay) {
  const PolyMesh mesh = heat_sink(8);
  RemeshOptions options;
  options.trace.vertices = 200;
  options.measure = false;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_NEAR(result.quads.mesh.vertex_count(), 200, 10);
  EXPECT_EQ(corners_without_vertex(result.quads.mesh, mesh), 0u);
  const ComparedSurfaces surfaces(result.mesh, result.quads);
  EXPECT_LT(measure_cells(surfaces).largest, 1e-6 * result.mesh.diagonal);
}

// There are 60 corners, and with all of them some hundred vertices.
TEST(Remesh, CornersMergeWhereTheyAreTooManyForACount) {
  const PolyMesh mesh = heat_sink(15);
  RemeshOptions options;
  options.trace.vertices = 60;
  options.measure = false;
  options.lines_only = true;
  const PolyMesh merged = remesh({mesh, {}, {}, {}}, options).quads.mesh;
  EXPECT_GT(corners_without_vertex(merged, mesh), 0u);
  options.mesh.corner_distance = 0;
  const PolyMesh kept = remesh({mesh, {}, {}, {}}, options).quads.mesh;
  EXPECT_EQ(corners_without_vertex(kept, mesh), 0u);
  EXPECT_LT(merged.vertex_count(), 0.9 * kept.vertex_count());
}

// A torus with so small an angle that all of its edges are features.
TEST(Remesh, SaysThatCornersAreTooMany) {
  SampleOptions sample;
  sample.faces = 500;
  RemeshOptions options;
  options.trace.vertices = 60;
  options.measure = false;
  const auto said_at = [&](double angle) {
    Listener listener;
    options.import.feature_angle_deg = angle;
    remesh({make_sample(SampleKind::torus, sample), {}, {}, {}}, options, listener);
    return listener.said;
  };
  EXPECT_NE(said_at(2).find("a larger --feature-angle makes fewer features"), std::string::npos)
      << said_at(2);
  EXPECT_EQ(said_at(180).find("a larger --feature-angle makes fewer features"), std::string::npos);
}

// All quads of a plate that is far smaller than lines are apart were two on the same corners: a
// surface, but one without a volume.
TEST(Remesh, PureQuadsOfTinyPiecesAreNotBackToBack) {
  SampleOptions sample;
  sample.faces = 1000;
  PolyMesh mesh = make_sample(SampleKind::sphere, sample);
  const double radius = mesh.positions[0].norm();
  for (int size = 1; size <= 6; ++size) {
    const Index first = mesh.vertex_count();
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1, 0.3 * (i >> 1 & 1), 0.02 * (i >> 2));
      mesh.positions.emplace_back(radius * (Vec3(2.2 + 0.3 * size, 0, 0) + 0.02 * size * corner));
    }
    for (const auto& [a, b, c, d] : std::vector<std::array<Index, 4>>{
             {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
      mesh.add_face(std::array<Index, 4>{first + a, first + b, first + c, first + d});
    }
  }
  for (const std::int64_t vertices : {60, 80, 100, 150}) {
    RemeshOptions options;
    options.trace.vertices = vertices;
    options.mesh.pure_quads = true;
    options.measure = false;
    const PolyMesh result = remesh({mesh, {}, {}, {}}, options).quads.mesh;
    std::set<std::vector<Index>> corners;
    for (Index f = 0; f < result.face_count(); ++f) {
      EXPECT_EQ(result.face(f).size(), 4u);
      std::vector<Index> own(result.face(f).begin(), result.face(f).end());
      std::ranges::sort(own);
      EXPECT_TRUE(corners.insert(own).second) << vertices;
    }
  }
}

}  // namespace
}  // namespace strake
