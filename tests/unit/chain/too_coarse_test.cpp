#include "strake/chain/too_coarse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <string>
#include <variant>
#include <vector>

#include "common/geometry/poly_topology/poly_topology.h"
#include "common/geometry/samples/samples.h"
#include "stages/import/stage.h"
#include "strake/chain/chain.h"
#include "strake/chain/remesh.h"
#include "strake/chain/session.h"
#include "tests/support/plates.h"
#include "tests/unit/chain/results.h"

namespace strake {
namespace {

/// A plate with so many pits that few vertices cannot run lines around them all.
PolyMesh pits(int along = 4) {
  std::vector<support::Disk> disks;
  const double middle = 0.5 * (along - 1);
  for (int i = 0; i < along; ++i) {
    for (int j = 0; j < along; ++j) disks.push_back({Vec2(i - middle, j - middle), 0.3, 20});
  }
  return support::pitted_plate(middle + 1, disks, 0.8);
}

/// Three for each pit.
constexpr Index kFewVertices = 48;

bool is_decimated(const RemeshResult& result) {
  return std::ranges::any_of(result.messages, [](const std::string& message) {
    return message.find("decimated instead") != std::string::npos;
  });
}

TEST(TooCoarse, DecimationTakesThePlaceOfLinesThatMissTheShape) {
  const PolyMesh mesh = pits(5);
  RemeshOptions options;
  options.trace.vertices = 165;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  ASSERT_TRUE(is_decimated(result));
  EXPECT_EQ(result.quads.mesh.vertex_count(), 165);
  EXPECT_EQ(measure_of(result, "shape.self_intersecting_pairs"), 0);
  EXPECT_EQ(analyse(result.quads.mesh).genus, 0);
  options.lines_only = true;
  const RemeshResult lines = remesh({mesh, {}, {}, {}}, options);
  EXPECT_FALSE(is_decimated(lines));
  EXPECT_GT(measure_of(lines, "shape.self_intersecting_pairs"), 0);
  EXPECT_LT(measure_of(result, "distance.rms"), measure_of(lines, "distance.rms"));
}

// Lines around so many pits are too many, or none at all.
TEST(TooCoarse, ACountIsMetThatLinesMiss) {
  const PolyMesh mesh = pits();
  RemeshOptions options;
  options.trace.vertices = kFewVertices;
  options.measure = false;
  EXPECT_EQ(remesh({mesh, {}, {}, {}}, options).quads.mesh.vertex_count(), kFewVertices);
  options.lines_only = true;
  const Index lines = remesh({mesh, {}, {}, {}}, options).quads.mesh.vertex_count();
  EXPECT_GT(std::abs(lines - kFewVertices), kFewVertices / 4);
}

/// A cube whose lines make twelve vertices, and nothing near to that.
PolyMesh cube() {
  PolyMesh mesh;
  for (int i = 0; i < 8; ++i) mesh.positions.emplace_back(i & 1, i >> 1 & 1, i >> 2);
  for (const auto& face : std::vector<std::array<Index, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    mesh.add_face(face);
  }
  return mesh;
}

// One vertex more than wanted is no reason to give up lines that are exact, and the words are of
// the count where it is missed by more.
TEST(TooCoarse, LinesNextToTheCountStay) {
  RemeshOptions options;
  options.trace.vertices = 11;
  const RemeshResult result = remesh({cube(), {}, {}, {}}, options);
  EXPECT_FALSE(is_decimated(result));
  EXPECT_EQ(result.quads.mesh.vertex_count(), 12);
  EXPECT_EQ(analyse(result.quads.mesh).quads, result.quads.mesh.face_count());
  options.measure = false;
  int decimated = 0;
  for (std::int64_t wanted = 20; wanted <= 40; ++wanted) {
    options.trace.vertices = wanted;
    const RemeshResult far = remesh({cube(), {}, {}, {}}, options);
    if (!is_decimated(far)) continue;
    ++decimated;
    EXPECT_TRUE(std::ranges::any_of(far.messages, [](const std::string& message) {
      return message.find("lines miss the count at") != std::string::npos;
    })) << wanted;
  }
  EXPECT_GT(decimated, 0);
}

/// Fins on a plate: the outline of a comb, extruded.
PolyMesh comb(int fins) {
  PolyMesh mesh;
  std::vector<Index> outline;
  const auto add = [&](double x, double z) {
    for (const double y : {0.0, 8.0}) mesh.positions.emplace_back(x, y, z);
    outline.push_back(mesh.vertex_count() - 2);
  };
  add(0, 0);
  add(2 * fins - 1, 0);
  for (int i = fins - 1; i >= 0; --i) {
    add(2 * i + 1, 20);
    add(2 * i, 20);
    if (i > 0) add(2 * i, 1);
    if (i > 0) add(2 * i - 1, 1);
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const Index a = outline[i];
    const Index b = outline[(i + 1) % outline.size()];
    mesh.add_face(std::array<Index, 4>{a, a + 1, b + 1, b});
  }
  std::vector<Index> back(outline.rbegin(), outline.rend());
  for (Index& v : back) ++v;
  mesh.add_face(outline);
  mesh.add_face(back);
  return mesh;
}

// For so few the fins cross each other, whatever is done; as many as lines take are enough.
TEST(TooCoarse, DecimatesToWhatLinesTakeWhereFewerDoNotShowTheShape) {
  RemeshOptions options;
  options.trace.vertices = 40;
  const RemeshResult result = remesh({comb(20), {}, {}, {}}, options);
  EXPECT_GT(result.quads.mesh.vertex_count(), 50);
  ASSERT_TRUE(is_decimated(result));
  EXPECT_EQ(measure_of(result, "shape.self_intersecting_pairs"), 0);
  EXPECT_TRUE(std::ranges::any_of(result.messages, [](const std::string& message) {
    return message.find("40 vertices were wanted") != std::string::npos &&
           message.find("faces of fewer cross, or miss the shape") != std::string::npos;
  }));
}

TEST(TooCoarse, FacesAreCountedLikewise) {
  RemeshOptions options;
  constexpr Index kWanted = 165;
  options.trace.faces = kWanted;
  options.measure = false;
  const RemeshResult result = remesh({pits(5), {}, {}, {}}, options);
  ASSERT_TRUE(is_decimated(result));
  EXPECT_NEAR(result.quads.mesh.face_count(), kWanted, 0.05 * kWanted);
}

TEST(TooCoarse, NothingChangesWhereLinesDo) {
  SampleOptions sample;
  sample.faces = 6000;
  const PolyMesh mesh = make_sample(SampleKind::ellipsoid, sample);
  RemeshOptions options;
  options.trace.vertices = 200;
  options.measure = false;
  const RemeshResult result = remesh({mesh, {}, {}, {}}, options);
  EXPECT_FALSE(is_decimated(result));
  options.lines_only = true;
  EXPECT_EQ(result.quads.mesh.positions, remesh({mesh, {}, {}, {}}, options).quads.mesh.positions);
}

/// Wavy sheets that lie close above each other, `along` quads wide.
PolyMesh close_sheets(int along) {
  PolyMesh mesh;
  for (int sheet = 0; sheet < 3; ++sheet) {
    const Index first = mesh.vertex_count();
    for (int j = 0; j <= along; ++j) {
      for (int i = 0; i <= along; ++i) {
        const double x = double(i) / along;
        const double y = double(j) / along;
        mesh.positions.emplace_back(x, y, 0.2 * std::sin(9 * x) * std::sin(7 * y) + 3e-4 * sheet);
      }
    }
    for (int j = 0; j < along; ++j) {
      for (int i = 0; i < along; ++i) {
        const Index a = first + j * (along + 1) + i;
        mesh.add_face(std::vector<Index>{a, a + 1, a + along + 2, a + along + 1});
      }
    }
  }
  return mesh;
}

/// The square from -2 to 2, `along` quads wide, at a height.
PolyMesh relief(int along, const std::function<double(double x, double y)>& height) {
  PolyMesh mesh;
  for (int j = 0; j <= along; ++j) {
    for (int i = 0; i <= along; ++i) {
      const double x = 4.0 * i / along - 2;
      const double y = 4.0 * j / along - 2;
      mesh.positions.emplace_back(x, y, height(x, y));
    }
  }
  for (int j = 0; j < along; ++j) {
    for (int i = 0; i < along; ++i) {
      const Index a = j * (along + 1) + i;
      mesh.add_face(std::vector<Index>{a, a + 1, a + along + 2, a + along + 1});
    }
  }
  return mesh;
}

/// Whether closer lines are in vain where those of a flat grid are all there is of a surface.
bool flat_grid_misses(const PolyMesh& surface, int along) {
  Listener listener;
  Session session(listener);
  const Stage import = import_stage();
  session.provide("input", Polygons{surface, "", {}}, "input", "");
  session.run(import);
  QuadMesh grid;
  grid.mesh = relief(along, [](double, double) { return 0.0; });
  grid.mesh_id = session.get<TriMesh>("mesh").id;
  session.provide("fitted", grid, "test", "");
  const Chain stages;
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  DecimatedRival rival(stages, Counted::vertices, grid.mesh.vertex_count());
  return rival.shows_what_lines_miss(session, crossing);
}

TEST(TooCoarse, CloserLinesAreInVainWhereDecimationFindsTheShape) {
  const auto peak = [](double x, double y) { return 2 * std::exp(-(x * x + y * y) / 0.1); };
  EXPECT_TRUE(flat_grid_misses(relief(80, peak), 11));
}

// What is as rough as its faces few vertices cannot show.
TEST(TooCoarse, CloserLinesMayDoWhereDecimationIsFarOffToo) {
  const auto rough = [](double x, double y) { return 0.1 * std::sin(31 * x) * std::sin(29 * y); };
  EXPECT_FALSE(flat_grid_misses(relief(80, rough), 11));
}

TEST(TooCoarse, CloserLinesMayDoWhereCellsAreNearTheShape) {
  const auto low = [](double x, double y) { return 0.02 * std::exp(-(x * x + y * y) / 0.1); };
  EXPECT_FALSE(flat_grid_misses(relief(80, low), 11));
}

/// Counts runs of decimation.
class DecimationCount : public Listener {
 public:
  void begin(const std::string& stage) override { runs += stage == "decimate" ? 1 : 0; }
  int runs = 0;
};

TEST(TooCoarse, TheRivalIsMadeOnceAndTakesThePlaceOfLines) {
  const auto peak = [](double x, double y) { return 2 * std::exp(-(x * x + y * y) / 0.1); };
  DecimationCount count;
  Session session(count);
  session.provide("input", Polygons{relief(80, peak), "", {}}, "input", "");
  session.run(import_stage());
  QuadMesh grid;
  grid.mesh = relief(11, [](double, double) { return 0.0; });
  grid.mesh_id = session.get<TriMesh>("mesh").id;
  session.provide("quads", grid, "test", "");
  session.provide("fitted", grid, "test", "");
  const Chain stages;
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const Index wanted = grid.mesh.vertex_count();
  DecimatedRival rival(stages, Counted::vertices, wanted);
  EXPECT_TRUE(rival.shows_what_lines_miss(session, crossing));
  EXPECT_TRUE(rival.is_better(session, crossing));
  EXPECT_TRUE(rival.replace_if_too_coarse(session, crossing));
  EXPECT_EQ(count.runs, 1);
  EXPECT_EQ(session.get<QuadMesh>("fitted").mesh.vertex_count(), wanted);
  EXPECT_EQ(session.get<QuadMesh>("quads").mesh.positions,
            session.get<QuadMesh>("decimated").mesh.positions);
  EXPECT_EQ(session.records().back().provenance.stage, "fit");
  EXPECT_FALSE(rival.is_better(session, crossing)) << "it is that itself";
}

TEST(TooCoarse, WhereTheTopologyEndsDecimationNoFewerAreAskedFor) {
  PolyMesh parts;  // tetrahedra, of which none can do with fewer vertices
  for (int i = 0; i < 64; ++i) {
    const Vec3 at(2 * (i % 4), 2 * (i / 4 % 4), 2 * (i / 16));
    for (const Vec3& p : {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      parts.positions.push_back(at + p);
    }
    for (const std::array<Index, 3>& face :
         {std::array<Index, 3>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) {
      parts.add_face(std::array{4 * i + face[0], 4 * i + face[1], 4 * i + face[2]});
    }
  }
  DecimationCount count;
  Session session(count);
  session.provide("input", Polygons{parts, "", {}}, "input", "");
  session.run(import_stage());
  QuadMesh same;
  same.mesh = parts;
  same.mesh_id = session.get<TriMesh>("mesh").id;
  session.provide("fitted", same, "test", "");
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  const Chain stages;
  DecimatedRival rival(stages, Counted::vertices, 100);
  EXPECT_FALSE(rival.is_better(session, crossing));
  EXPECT_EQ(count.runs, 1);
}

// Faces along lines cross from sheet to sheet, and decimation makes no vertices.
TEST(TooCoarse, MoreThanTheInputHasIsNamed) {
  RemeshOptions options;
  options.trace.vertices = 3260;
  options.measure = false;
  const RemeshResult result = remesh({close_sheets(30), {}, {}, {}}, options);
  ASSERT_TRUE(is_decimated(result));
  const Index given = result.mesh.vertex_count();
  ASSERT_LT(given, 0.95 * 3260);
  EXPECT_LE(result.quads.mesh.vertex_count(), given);
  const auto is_said = [&](const std::string& text) {
    return std::ranges::any_of(result.messages, [&](const std::string& message) {
      return message.find(text) != std::string::npos;
    });
  };
  EXPECT_TRUE(is_said("no more vertices than the " + std::to_string(given) + " of the input"));
  EXPECT_FALSE(is_said("too coarse"));
  EXPECT_FALSE(is_said("ask for more"));
}

/// Two wavy sheets above each other.
PolyMesh two_reliefs(double gap) {
  PolyMesh mesh;
  for (int sheet = 0; sheet < 2; ++sheet) {
    const Index first = mesh.vertex_count();
    const PolyMesh one = relief(60, [&](double x, double y) {
      return 0.3 * std::sin(3 * x) * std::sin(2 * y) + gap * sheet;
    });
    mesh.positions.insert(mesh.positions.end(), one.positions.begin(), one.positions.end());
    for (Index f = 0; f < one.face_count(); ++f) {
      std::vector<Index> face(one.face(f).begin(), one.face(f).end());
      for (Index& v : face) v += first;
      mesh.add_face(face);
    }
  }
  return mesh;
}

// Collapses know nothing of the other sheet; with a few more or less of them other faces are left.
TEST(TooCoarse, DecimatedFacesThatCrossArePartedByCountsNearby) {
  Listener listener;
  Session session(listener);
  session.provide("input", Polygons{two_reliefs(0.03), "", {}}, "input", "");
  session.run(import_stage());
  const Chain stages;
  CrossingPlaces crossing(session.get<TriMesh>("mesh"));
  int parted = 0;
  for (const int count : {243, 303}) {
    Session decimated = session;
    stages.decimate.option("decimate-vertices").parse_into(std::to_string(count));
    decimated.run(stages.decimate);
    decimated.provide_as("quads", decimated.get<QuadMesh>("decimated"), "decimated");
    decimated.run(stages.fit);
    const std::size_t before = crossing.of(decimated.get<QuadMesh>("fitted").mesh).size();
    part_decimated(decimated, stages, {Counted::vertices, count, count, 0}, crossing);
    const PolyMesh& result = decimated.get<QuadMesh>(result_port(decimated)).mesh;
    const std::size_t left = crossing.of(result).size();
    EXPECT_LE(left, before);
    EXPECT_NEAR(result.vertex_count(), count, 0.02 * count);
    parted += before > 0 && left == 0 ? 1 : 0;
  }
  EXPECT_GT(parted, 0);
}

// A third of the vertices lies beyond their neighbours.
TEST(TooCoarse, TangledFacesWithinAToleranceGiveWayToTheSurface) {
  const auto waves = [](double x, double y) { return 0.2 * std::sin(3 * x) * std::sin(2 * y); };
  const PolyMesh surface = relief(20, waves);
  Listener listener;
  Session session(listener);
  session.provide("input", Polygons{surface, "", {}}, "input", "");
  session.run(import_stage());
  const auto& mesh = session.get<TriMesh>("mesh");
  QuadMesh tangled;
  tangled.mesh = surface;
  tangled.mesh_id = mesh.id;
  for (Index v = 0; v < surface.vertex_count(); v += 3) {
    Vec3& p = tangled.mesh.positions[v];
    p.x() += 0.3;
    p.z() = waves(p.x(), p.y());
  }
  session.provide("refined", tangled, "test", "");
  const Chain stages;
  stages.refine.option("refine-tolerance").parse_into("0.1%");
  CrossingPlaces crossing(mesh);
  const std::size_t faces = crossing.of(tangled.mesh).size();
  ASSERT_GT(faces, 100);

  EXPECT_FALSE(decimate_if_tangled(session, stages, crossing, 1));
  EXPECT_EQ(session.get<QuadMesh>("refined").mesh.positions, tangled.mesh.positions);
  EXPECT_EQ(listener.said.find("decimat"), std::string::npos);

  EXPECT_TRUE(decimate_if_tangled(session, stages, crossing, faces));
  const PolyMesh& result = session.get<QuadMesh>("refined").mesh;
  EXPECT_TRUE(crossing.of(result).empty());
  EXPECT_LE(result.vertex_count(), surface.vertex_count());
  EXPECT_NE(listener.said.find("decimated instead"), std::string::npos);
}

TEST(TooCoarse, PureQuadsAndGuidesNeedLines) {
  RemeshOptions options;
  options.trace.vertices = kFewVertices;
  options.mesh.pure_quads = true;
  options.measure = false;
  const PolyMesh mesh = pits();
  EXPECT_FALSE(is_decimated(remesh({mesh, {}, {}, {}}, options)));
  options.mesh.pure_quads = false;
  const GuideLines guides = {{{Vec3(-2, 0.1, 0), Vec3(2, 0.1, 0)}}, "guides"};
  EXPECT_FALSE(is_decimated(remesh({mesh, {}, guides, {}}, options)));
}

}  // namespace
}  // namespace strake
