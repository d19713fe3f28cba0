#include "strake/chain/facet_trial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "stages/import/stage.h"

namespace strake {
namespace {

class LineListener : public StageObserver {
 public:
  void report(std::string_view /*phase*/, double /*fraction*/) override {}
  void say(const std::string& line) override { said.push_back(line); }
  std::vector<std::string> said;
};

/// A roof of four long strips, bent by 20 degrees each, which import may keep as facets.
PolyMesh roof() {
  PolyMesh mesh;
  constexpr int kStrips = 4;
  for (int i = 0; i <= kStrips; ++i) {
    const double turn = (i - 2) * 20 * M_PI / 180;
    for (const double y : {0.0, 4.0})
      mesh.positions.emplace_back(std::sin(turn), y, std::cos(turn));
  }
  for (Index i = 0; i < kStrips; ++i) {
    mesh.add_face(std::array<Index, 4>{2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1});
  }
  return mesh;
}

/// A way whose results are those given: without facets, and with them.
class Trial {
 public:
  Trial(QuadMesh plain, QuadMesh faceted)
      : plain_(std::move(plain)), faceted_(std::move(faceted)), import_(import_stage()) {
    warner_.name = "warner";
    warner_.output = {"warned", PortKind::report, ""};
    warner_.run = [](Inputs& inputs, Observer& /*observer*/) {
      StageResult result;
      const auto& mesh = inputs.get<TriMesh>("mesh");
      const bool has_facets = std::ranges::count(mesh.is_feature, 1) > 0;
      result.report.warn("of both");
      result.report.warn(has_facets ? "of facets" : "of none");
      return result;
    };
    warner_.inputs = {{"mesh", PortKind::mesh, ""}};
  }

  /// \return the result for as many vertices as the first one has
  QuadMesh run(bool keeps = false) {
    Session session(listener);
    session.provide("input", Polygons{roof(), "", {}}, "input", "");
    if (keeps) {
      session.keep_with(
          [&](const Session::Kept& kept) {
            ++kept_times;
            kept_features = std::ranges::count(std::get<TriMesh>(*kept.output).is_feature, 1);
            return std::string();
          },
          [](const Value&, const TriMesh*) { return std::string(); });
    }
    const Option& height = import_.option("facet-height");
    const WayToResult way{{&import_},
                          [&](Session& other) {
                            other.run(import_);
                            other.keep(import_);
                          },
                          [&](Session& other) {
                            const bool has_facets = !height.value().empty();
                            other.run(warner_);
                            other.say(has_facets ? "warning: of facets" : "warning: of none");
                            QuadMesh result = has_facets ? faceted_ : plain_;
                            result.mesh_id = other.get<TriMesh>("mesh").id;
                            other.provide("fitted", result, "test", "");
                            return std::string("fitted");
                          }};
    const std::string port = make_with_facets_if_better(
        session, way, height, Length{1e-4, true}, Counted::vertices, plain_.mesh.vertex_count());
    EXPECT_EQ(&session.observer(), &listener);
    return session.get<QuadMesh>(port);
  }

  [[nodiscard]] bool was_said(const std::string& line) const {
    return std::ranges::count(listener.said, line) > 0;
  }

  LineListener listener;
  std::ptrdiff_t kept_features = 0;
  int kept_times = 0;

 private:
  QuadMesh plain_;
  QuadMesh faceted_;
  Stage import_;
  Stage warner_;  ///< whose warnings tell which trial it ran in
};

QuadMesh quads_of(const PolyMesh& mesh) {
  QuadMesh quads;
  quads.mesh = mesh;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    quads.provenance.face.push_back(0);
    quads.provenance.barycentric.push_back({1, 0, 0});
    quads.provenance.lines.push_back({kNone, kNone});
  }
  return quads;
}

QuadMesh exact() { return quads_of(roof()); }

/// The roof with its ridge pressed down.
QuadMesh off() {
  PolyMesh mesh = roof();
  for (const Index v : {4, 5}) mesh.positions[v].z() -= 0.5;
  return quads_of(mesh);
}

/// All faces cut into triangles.
QuadMesh triangles() {
  const PolyMesh whole = roof();
  PolyMesh mesh;
  mesh.positions = whole.positions;
  for (Index f = 0; f < whole.face_count(); ++f) {
    const auto face = whole.face(f);
    mesh.add_face(std::array{face[0], face[1], face[2]});
    mesh.add_face(std::array{face[0], face[2], face[3]});
  }
  return quads_of(mesh);
}

/// The roof with a vertex of its ridge near the other one.
QuadMesh thin() {
  PolyMesh mesh = roof();
  mesh.positions[5].y() = 0.05;
  return quads_of(mesh);
}

TEST(FacetTrial, WhatIsNearerIsTaken) {
  Trial trial(off(), exact());
  EXPECT_EQ(trial.run().mesh.positions, exact().mesh.positions);
  EXPECT_TRUE(trial.was_said("warning: of facets"));
  EXPECT_FALSE(trial.was_said("warning: of none"));
  EXPECT_TRUE(trial.was_said("warner: warning: of both"));
  EXPECT_TRUE(trial.was_said("warner: warning: of facets"));
  EXPECT_FALSE(trial.was_said("warner: warning: of none"));
}

TEST(FacetTrial, WhatIsFarOffOrThinOrHasFewQuadsIsNotTaken) {
  for (const QuadMesh& worse : {off(), thin(), triangles()}) {
    Trial trial(off(), worse);
    EXPECT_EQ(trial.run().mesh.corners, off().mesh.corners);
    EXPECT_TRUE(trial.was_said("warning: of none"));
    EXPECT_FALSE(trial.was_said("warning: of facets"));
    EXPECT_TRUE(trial.was_said("warner: warning: of both"));
    EXPECT_FALSE(trial.was_said("warner: warning: of facets"));
  }
}

TEST(FacetTrial, GoodResultsAreTakenAtOnce) {
  Trial trial(exact(), off());
  EXPECT_EQ(trial.run().mesh.positions, exact().mesh.positions);
  const std::vector<std::string> said = {"warner: warning: of both", "warner: warning: of none",
                                         "warning: of none"};
  EXPECT_EQ(trial.listener.said, said);
}

// A result that was not taken leaves nothing beside what was.
TEST(FacetTrial, OnlyWhatIsTakenIsKept) {
  Trial with(off(), exact());
  with.run(true);
  EXPECT_GT(with.kept_features, 0);
  EXPECT_EQ(with.kept_times, 1);
  Trial without(off(), triangles());
  without.run(true);
  EXPECT_EQ(without.kept_features, 0);
  EXPECT_EQ(without.kept_times, 1);
}

}  // namespace
}  // namespace strake
