#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/core/tolerance_error.h"
#include "common/geometry/cell_error/cell_error.h"
#include "common/geometry/face_crossings/face_crossings.h"
#include "common/geometry/poly_topology/face_shape.h"
#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "strake/chain/remesh.h"
#include "tests/support/cones.h"
#include "tests/support/plates.h"

namespace strake {
namespace {

/// A unit sphere with a ring of claws around its pole, closer together than wanted cells are wide.
/// \param apart  angle of the claws from the pole
/// \param width  angle at which a claw has 1/e of its height
PolyMesh claws(int count, double apart, double width, double height, std::int64_t faces) {
  SampleOptions options;
  options.faces = faces;
  PolyMesh mesh = make_sample(SampleKind::sphere, options);
  for (Vec3& p : mesh.positions) {
    const Vec3 direction = p.normalized();
    double radius = 1;
    for (int i = 0; i < count; ++i) {
      const double turn = 2 * M_PI * i / count;
      const Vec3 tip(std::sin(apart) * std::cos(turn), std::sin(apart) * std::sin(turn),
                     std::cos(apart));
      const double angle = std::acos(std::clamp(direction.dot(tip), -1.0, 1.0)) / width;
      radius += height * std::exp(-angle * angle);
    }
    p = radius * direction;
  }
  return mesh;
}

std::size_t crossings(const PolyMesh& mesh) {
  return find_crossing_faces(mesh.positions, triangulate_faces(mesh)).size();
}

class Listener : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
  void say(const std::string& line) override { said += line + '\n'; }
  std::string said;
};

// Lines for so few vertices pass a tip by that is a sixth as wide as they are apart.
TEST(Remesh, WithFewVerticesATipStays) {
  const PolyMesh mesh = claws(1, 0.8, 0.06, 0.4, 20000);
  RemeshOptions options;
  options.trace.vertices = 90;
  options.lines_only = true;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_NEAR(result.quads.mesh.vertex_count(), 90, 9);
  const ErrorMap map = measure_cells(ComparedSurfaces(result.mesh, result.quads));
  EXPECT_LT(map.largest, 0.1);
}

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

// What dividing cells proves is measured again in another way, from points.
TEST(Remesh, ATolerancesProofIsChecked) {
  SampleOptions sample;
  sample.faces = 2000;
  RemeshInput input{make_sample(SampleKind::torus, sample), {}, {}, {}};
  RemeshOptions options;
  options.trace.tolerance = percent(0.5);
  EXPECT_NO_THROW(remesh(input, options));
  options.evaluate.tolerance = percent(0.01);
  EXPECT_THROW(remesh(input, options), ToleranceError);
  // Nothing is proven of a result that may miss the tolerance.
  options.evaluate.tolerance.reset();
  options.trace.tolerance = percent(0.05);
  options.refine.rounds = 0;
  EXPECT_THROW(remesh(input, options), ToleranceError);
  options.refine.partly = true;
  EXPECT_NO_THROW(remesh(input, options));
}

// As marching cubes leave them where values lie at the level: several vertices in each place, and
// from a face on a line of faces without area, which nobody sees. The proof took those of the
// result for a surface, and what measures it did not.
TEST(Remesh, WithinAToleranceFacesWithoutAreaAreNoSurface) {
  const Vec3 tip(-0.529411765, 0.00588235294, 0.9);
  const Vec3 root(-0.529411765, 0.0235294118, 0.9);
  PolyMesh mesh;
  mesh.positions = {tip,
                    tip,
                    root,
                    root,
                    Vec3(-0.529411765, 0.0245006786, 0.882352941),
                    tip,
                    root,
                    Vec3(-0.529411765, 0.0411764706, 0.9)};
  for (const auto& face : std::vector<std::array<Index, 3>>{
           {5, 0, 6}, {2, 6, 0}, {6, 3, 1}, {6, 1, 5}, {4, 7, 2}, {6, 2, 7}, {7, 3, 6}}) {
    mesh.add_face(face);
  }
  RemeshOptions options;
  options.trace.tolerance = Length{0.003, false};
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_GT(result.quads.mesh.face_count(), 0);
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
  for (const std::int64_t vertices : {450, 500, 600, 700, 900}) {
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

// Whatever made a result last, programs that cut faces into fans see the surface that was measured.
TEST(Remesh, FansOfFacesAreTheSurfaceMeasured) {
  const PolyMesh mesh = claws(4, 0.25, 0.1, 0.6, 6000);
  RemeshOptions within;
  within.trace.tolerance = percent(0.5);
  RemeshOptions counted;
  counted.trace.vertices = 700;
  RemeshOptions decimated;
  decimated.trace.vertices = 60;
  for (RemeshOptions* options : {&within, &counted, &decimated}) {
    options->measure = false;
    const PolyMesh result = remesh({mesh, {}, {}, {}}, *options).quads.mesh;
    PolyMesh begun = result;
    begin_faces_at_fans(begun);
    EXPECT_EQ(begun.corners, result.corners);
  }
}

/// Share of the vertices of a closed mesh that four faces meet in.
double regular_share(const PolyMesh& mesh) {
  std::vector<int> faces(mesh.positions.size(), 0);
  for (const Index v : mesh.corners) ++faces[v];
  return static_cast<double>(std::ranges::count(faces, 4)) / static_cast<double>(faces.size());
}

// Lines that are closer where errors are large leave fewer cells to divide, and so more vertices
// are regular.
TEST(Remesh, LinesAreCloserWhereAToleranceIsExceeded) {
  RemeshOptions options;
  options.trace.tolerance = percent(0.3);
  options.measure = false;
  for (const double width : {0.06, 0.08, 0.1}) {
    const PolyMesh mesh = claws(12, 0.9, width, 0.2, 20000);
    const auto share = [&](std::int64_t rounds) {
      options.feedback_rounds = rounds;
      return regular_share(remesh({mesh, {}, {}, {}}, options).quads.mesh);
    };
    EXPECT_GT(share(1), share(0) + 0.02) << width;
  }
}

// Cells between claws lie over more than one side of them, and no division brings these within the
// tolerance: what is far from claws needs no more vertices for that than without any.
TEST(Remesh, LinesAreCloserOnlyWhereDividingDoesNotReachTheTolerance) {
  SampleOptions sample;
  sample.faces = 8000;
  const auto vertices_below = [](const PolyMesh& mesh) {
    RemeshOptions options;
    options.trace.tolerance = {0.01, false};
    options.measure = false;
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
    const auto is_below = [](const Vec3& p) { return p.z() < -0.2; };
    return static_cast<double>(std::ranges::count_if(result.quads.mesh.positions, is_below));
  };
  EXPECT_LT(vertices_below(claws(6, 0.3, 0.08, 0.6, 8000)),
            1.5 * vertices_below(make_sample(SampleKind::sphere, sample)));
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
  for (const Ring& ring : {Ring{12, 0.25, 0.05}, Ring{10, 0.2, 0.04}, Ring{12, 0.2, 0.04}}) {
    const PolyMesh mesh = claws(ring.count, ring.apart, ring.width, 0.6, 20000);
    const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
    EXPECT_EQ(crossings(result.quads.mesh), 0u) << ring.count << " claws";
    have_crossed |= std::ranges::any_of(
        result.reports, [](const auto& report) { return report.first == "refine-uncross"; });
  }
  EXPECT_TRUE(have_crossed);
}

double largest_distance(const RemeshResult& result) {
  for (const auto& [stage, report] : result.reports) {
    for (const auto& [name, value] : report.entries()) {
      if (name == "distance.max") return std::get<double>(value);
    }
  }
  return std::nan("");
}

// Lines three times as far apart as usual pass a tip by: 2.8 % of the diagonal.
TEST(Remesh, WithoutAGoalATipStays) {
  const PolyMesh mesh = claws(1, 0.8, 0.06, 0.4, 20000);
  RemeshOptions options;
  options.trace.spacing_scale = 3;
  Listener listener;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options, listener);
  EXPECT_NE(listener.said.find("tracing closer lines there"), std::string::npos);
  EXPECT_LT(largest_distance(result), 0.01 * result.mesh.diagonal);
  EXPECT_LT(result.quads.mesh.vertex_count(), 650);
}

TEST(Remesh, WithoutAGoalErrorsAreEven) {
  RemeshOptions options;
  const PolyMesh mesh = claws(4, 0.8, 0.25, 0.6, 20000);
  const RemeshResult even = remesh({mesh, {}, {}, {}}, options);
  options.feedback_rounds = 0;
  const RemeshResult once = remesh({mesh, {}, {}, {}}, options);
  EXPECT_LT(largest_distance(even), 0.7 * largest_distance(once));
  EXPECT_LT(even.quads.mesh.vertex_count(), 1.5 * once.quads.mesh.vertex_count());
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

// On flats lines are farther apart than the blocks are wide.
TEST(Remesh, WithoutAGoalLinesAreCloseEnough) {
  RemeshOptions options;
  Listener listener;
  const PolyMesh mesh = city(24);
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options, listener);
  EXPECT_NE(listener.said.find("tracing closer lines"), std::string::npos);
  EXPECT_EQ(crossings(result.quads.mesh), 0u);
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

// A torus with so small an angle that all of its edges are features.
TEST(Remesh, SaysThatCornersStay) {
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
  EXPECT_NE(said_at(2).find("a larger --feature-angle keeps fewer"), std::string::npos)
      << said_at(2);
  EXPECT_EQ(said_at(180).find("a larger --feature-angle keeps fewer"), std::string::npos);
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

/// A cylinder along z, closed by two fans, with rings evenly between those a hundredth from its
/// ends.
PolyMesh rod(Index sides, Index rings, double length) {
  PolyMesh mesh;
  for (Index r = 0; r < rings; ++r) {
    const double share = 0.01 + 0.98 * (r - 1) / (rings - 3);
    for (Index i = 0; i < sides; ++i) {
      const double angle = 2 * M_PI * i / sides;
      mesh.positions.emplace_back(0.5 * std::cos(angle), 0.5 * std::sin(angle),
                                  length * std::clamp(share, 0.0, 1.0));
    }
  }
  const Index ends = mesh.vertex_count();
  mesh.positions.emplace_back(0, 0, 0);
  mesh.positions.emplace_back(0, 0, length);
  const Index last = ends - sides;
  for (Index i = 0; i < sides; ++i) {
    const Index next = (i + 1) % sides;
    for (Index r = 0; r < last; r += sides) {
      mesh.add_face(std::array<Index, 4>{r + i, r + next, r + sides + next, r + sides + i});
    }
    mesh.add_face(std::array<Index, 3>{ends, next, i});
    mesh.add_face(std::array<Index, 3>{ends + 1, last + i, last + next});
  }
  return mesh;
}

double volume(const PolyMesh& mesh) {
  double sum = 0;
  for (const auto& [a, b, c] : triangulate_faces(mesh).corners) {
    sum += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6;
  }
  return sum;
}

// All of it is within three times its thickness of all of it, inside out, too.
TEST(Remesh, WhatIsThinnerThanTheToleranceIsNotTurnedInsideOut) {
  const PolyMesh mesh = rod(24, 62, 1000);
  RemeshOptions options;
  options.trace.tolerance = percent(0.3);
  options.measure = false;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_EQ(crossings(result.quads.mesh), 0u);
  // A square within a circle has 2/pi of its area.
  EXPECT_GT(volume(result.quads.mesh), 2 / M_PI * volume(mesh));
}

// Within a tolerance that its own faces are coarse against a mesh is a polyhedron with many edges.
TEST(Remesh, SaysWhereAToleranceTakesFarMoreVerticesThanTheInputHas) {
  const auto said_with = [](std::int64_t faces) {
    SampleOptions sample;
    sample.faces = faces;
    const PolyMesh mesh = make_sample(SampleKind::torus, sample);
    RemeshOptions options;
    options.trace.tolerance = percent(0.1);
    options.measure = false;
    Listener listener;
    remesh({mesh, {}, {}, {}}, options, listener);
    return listener.said;
  };
  EXPECT_NE(said_with(500).find("a larger --tolerance takes fewer"), std::string::npos);
  EXPECT_EQ(said_with(5000).find("a larger --tolerance takes fewer"), std::string::npos);
}

}  // namespace
}  // namespace strake
