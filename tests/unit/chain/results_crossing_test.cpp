#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/geometry/poly_topology/poly_topology.h"
#include "strake/chain/remesh.h"
#include "tests/support/plates.h"
#include "tests/unit/chain/results.h"

namespace strake {
namespace {

// With lines for the tolerance alone cells lie across a claw, and dividing them leaves hundreds
// of pairs of faces that cross.
TEST(Remesh, WithinAToleranceFacesDoNotCross) {
  RemeshOptions options;
  options.trace.tolerance = percent(0.7);
  options.measure = false;
  const PolyMesh mesh = claws(4, 0.25, 0.1, 0.6, 12000);
  ASSERT_EQ(crossings(mesh), 0u);
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_EQ(crossings(result.quads.mesh), 0u);
}

// Likewise with so few vertices that a claw has four or five.
TEST(Remesh, WithFewVerticesFacesDoNotCross) {
  RemeshOptions options;
  options.trace.vertices = 200;
  options.measure = false;
  const PolyMesh mesh = claws(6, 0.3, 0.08, 0.6, 8000);
  ASSERT_EQ(crossings(mesh), 0u);
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_EQ(crossings(result.quads.mesh), 0u);
  EXPECT_NEAR(result.quads.mesh.vertex_count(), 200, 10);
}

// The input's own faces are instead of those that cross, which takes less time than all lines anew.
TEST(Remesh, LinesAreNotTracedAgainForSingleFacesThatCross) {
  const PolyMesh mesh = claws(10, 0.3, 0.05, 0.6, 20000);
  std::int64_t uncrossed = 0;
  for (const std::int64_t vertices : {500, 600, 700, 800, 1000}) {
    RemeshOptions options;
    options.trace.vertices = vertices;
    options.measure = false;
    Listener listener;
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options, listener);
    EXPECT_EQ(listener.said.find("faces cross"), std::string::npos) << listener.said;
    EXPECT_EQ(crossings(result.quads.mesh), 0u);
    EXPECT_NEAR(static_cast<double>(result.quads.mesh.vertex_count()),
                static_cast<double>(vertices), 0.05 * static_cast<double>(vertices));
    for (const auto& [stage, report] : result.reports) {
      for (const auto& [name, value] : report.entries()) {
        if (name == "refine.uncrossed_faces") uncrossed += std::get<std::int64_t>(value);
      }
    }
  }
  EXPECT_GT(uncrossed, 0);
}

// Crossing faces are not made anew then: that takes triangles.
TEST(Remesh, PureQuadsStayQuads) {
  RemeshOptions options;
  options.trace.vertices = 200;
  options.mesh.pure_quads = true;
  options.measure = false;
  const PolyMesh result = remesh({claws(6, 0.3, 0.08, 0.6, 8000), {}, {}, {}}, options).quads.mesh;
  EXPECT_EQ(result.corners.size(), 4u * static_cast<std::size_t>(result.face_count()));
  for (Index f = 0; f < result.face_count(); ++f) EXPECT_EQ(result.face(f).size(), 4u);
}

// Straight edges of cells that are larger than pits in a plate run across them.
TEST(Remesh, WithFewVerticesFacesOfAPlateDoNotCross) {
  std::vector<support::Disk> pits;
  for (int i = 0; i < 5; ++i) {
    pits.push_back({Vec2(-3 + 1.3 * i, 0.4 * std::sin(2.0 * i)), 0.5, 24});
    pits.push_back({Vec2(-2.4 + 1.3 * i, 1.4 + 0.2 * std::cos(3.0 * i)), 0.25, 16});
  }
  RemeshOptions options;
  options.measure = false;
  const PolyMesh mesh = support::pitted_plate(10, pits, 0.05);
  ASSERT_EQ(crossings(mesh), 0u);
  for (const std::int64_t vertices : {260, 340}) {
    options.trace.vertices = vertices;
    const PolyMesh result = remesh({mesh, {}, {}, {}}, options).quads.mesh;
    EXPECT_EQ(crossings(result), 0u) << vertices;
    EXPECT_NEAR(static_cast<double>(result.vertex_count()), static_cast<double>(vertices),
                0.05 * static_cast<double>(vertices));
    const auto quads = static_cast<double>(analyse(result).quads);
    EXPECT_GT(quads, 0.8 * result.face_count()) << vertices;
  }
}

// Between claws cells of the spacing that is the default cross.
TEST(Remesh, WithoutAGoalFacesDoNotCross) {
  RemeshOptions options;
  options.measure = false;
  options.feedback_rounds = 0;
  struct Ring {
    int count;
    double apart;
    double width;
  };
  bool have_crossed = false;
  for (const Ring& ring : {Ring{12, 0.2, 0.03}, Ring{8, 0.2, 0.05}, Ring{16, 0.25, 0.04}}) {
    const PolyMesh mesh = claws(ring.count, ring.apart, ring.width, 0.6, 20000);
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
    EXPECT_EQ(crossings(result.quads.mesh), 0u) << ring.count << " claws";
    have_crossed |= std::ranges::any_of(
        result.reports, [](const auto& report) { return report.first == "refine-uncross"; });
  }
  EXPECT_TRUE(have_crossed);
}

/// Blocks of different heights with streets between them, of unit squares: open below.
PolyMesh city(int blocks) {
  const int n = 2 * blocks + 1;
  std::mt19937 random(3);
  std::vector<int> height(static_cast<std::size_t>(n) * n, 0);
  for (int y = 1; y < n; y += 2) {
    for (int x = 1; x < n; x += 2) {
      const int h = 1 + static_cast<int>(random() % 5);
      if (random() % 2 == 0) height[static_cast<std::size_t>(y) * n + x] = h;
    }
  }
  std::map<std::array<int, 3>, Index> vertices;
  PolyMesh mesh;
  const auto vertex = [&](int x, int y, int z) {
    const auto [at, is_new] = vertices.try_emplace({x, y, z}, mesh.vertex_count());
    if (is_new) mesh.positions.emplace_back(x, y, z);
    return at->second;
  };
  const auto at = [&](int x, int y) {
    return x < 0 || y < 0 || x >= n || y >= n ? 0 : height[static_cast<std::size_t>(y) * n + x];
  };
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      const int h = at(x, y);
      mesh.add_face(std::array<Index, 4>{vertex(x, y, h), vertex(x + 1, y, h),
                                         vertex(x + 1, y + 1, h), vertex(x, y + 1, h)});
      for (int z = 0; z < h; ++z) {
        const auto wall = [&](int beyond, int ax, int ay, int bx, int by) {
          if (beyond > z) return;
          mesh.add_face(std::array<Index, 4>{vertex(ax, ay, z), vertex(bx, by, z),
                                             vertex(bx, by, z + 1), vertex(ax, ay, z + 1)});
        };
        wall(at(x, y - 1), x, y, x + 1, y);
        wall(at(x + 1, y), x + 1, y, x + 1, y + 1);
        wall(at(x, y + 1), x + 1, y + 1, x, y + 1);
        wall(at(x - 1, y), x, y + 1, x, y);
      }
    }
  }
  return mesh;
}

// On flats lines are farther apart than the blocks are wide. Where the ground is dished, no flat is
// drawn anew.
TEST(Remesh, WithoutAGoalLinesAreCloseEnough) {
  for (const double dish : {0.0, 0.01}) {
    RemeshOptions options;
    Listener listener;
    PolyMesh mesh = city(24);
    for (Vec3& p : mesh.positions) p.z() += dish * p.head<2>().squaredNorm();
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options, listener);
    EXPECT_EQ(crossings(result.quads.mesh), 0u) << dish;
    EXPECT_EQ(listener.said.find("tracing closer lines") != std::string::npos, dish > 0) << dish;
  }
}

// Quads alone are neither made anew where they cross nor replaced.
TEST(Remesh, SaysThatFacesCross) {
  RemeshOptions options;
  options.trace.vertices = 200;
  options.mesh.pure_quads = true;
  options.measure = false;
  const auto said_of = [&](double height) {
    Listener listener;
    const PolyMesh mesh = claws(12, 0.4, 0.05, height, 20000);
    const PolyMesh result = remesh({mesh, {}, {}, {}}, options, listener).quads.mesh;
    return std::pair(crossings(result), listener.said);
  };
  constexpr const char* kWarning = "cross others where the input does not";
  const auto [crossing, said] = said_of(0.8);
  ASSERT_GT(crossing, 0u);
  EXPECT_NE(said.find(kWarning), std::string::npos) << said;
  const auto [none, nothing] = said_of(0.0);
  ASSERT_EQ(none, 0u);
  EXPECT_EQ(nothing.find(kWarning), std::string::npos) << nothing;
}

/// The squares around two cubes that have an edge in common, which is one of four faces.
PolyMesh cubes_on_an_edge(int n) {
  const auto is_solid = [&](const std::array<int, 3>& at) {
    return at[2] >= 0 && at[2] < n && at[0] >= 0 && at[1] >= 0 && at[0] < 2 * n && at[1] < 2 * n &&
           at[0] / n == at[1] / n;
  };
  PolyMesh mesh;
  std::map<std::array<int, 3>, Index> vertices;
  const auto add_side = [&](const std::array<int, 3>& cube, int axis, int side) {
    std::array<Index, 4> face;
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> corner = cube;
      corner[axis] += side;
      corner[(axis + 1) % 3] += k == 1 || k == 2 ? 1 : 0;
      corner[(axis + 2) % 3] += k >= 2 ? 1 : 0;
      const auto [at, is_new] = vertices.try_emplace(corner, mesh.vertex_count());
      if (is_new) mesh.positions.emplace_back(corner[0], corner[1], corner[2]);
      face[side == 1 ? k : 3 - k] = at->second;
    }
    mesh.add_face(face);
  };
  for (int i = 0; i < 4 * n * n * n; ++i) {
    const std::array<int, 3> cube = {i % (2 * n), i / (2 * n) % (2 * n), i / (4 * n * n)};
    if (!is_solid(cube)) continue;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beside = cube;
        beside[axis] += 2 * side - 1;
        if (!is_solid(beside)) add_side(cube, axis, side);
      }
    }
  }
  return mesh;
}

// Their cells meet along the edge as they are divided differently, which is no fault of the lines.
TEST(Remesh, SolidsThatTouchKeepTheirLines) {
  for (const std::int64_t vertices : {500, 2000}) {
    RemeshOptions options;
    options.trace.vertices = vertices;
    options.measure = false;
    Listener listener;
    const PolyMesh result =
        remesh({cubes_on_an_edge(10), {}, {}, {}}, options, listener).quads.mesh;
    EXPECT_EQ(listener.said.find("cross others"), std::string::npos) << listener.said;
    EXPECT_EQ(listener.said.find("faces cross"), std::string::npos) << listener.said;
    EXPECT_EQ(listener.said.find("decimat"), std::string::npos) << listener.said;
    // All but a few cells in the eight corners of each cube, and where a line ends.
    const auto quads = static_cast<double>(analyse(result).quads);
    EXPECT_GT(quads, 0.97 * result.face_count()) << vertices;
  }
}

}  // namespace
}  // namespace strake
