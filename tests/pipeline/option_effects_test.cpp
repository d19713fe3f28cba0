// Options of strake remesh that shape the result do so from the command line.

#include <Eigen/Geometry>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/artifact/meshfile/mesh_reader.h"
#include "common/geometry/samples/samples.h"
#include "tests/pipeline/run_program.h"
#include "tests/support/models.h"

namespace strake::pipeline_test {
namespace {

class OptionEffects : public ProgramTest {
 protected:
  /// What evaluate says of a run.
  nlohmann::json judged(const std::string& arguments) {
    must("strake remesh " + arguments + " -q -o out.obj --report report.json");
    return told_by("evaluate");
  }
  /// What a stage said of the last run.
  nlohmann::json told_by(const std::string& stage) {
    return nlohmann::json::parse(bytes("report.json")).at(stage).at("result");
  }
  static int vertices(const nlohmann::json& result) {
    return result.at("topology").at("candidate").at("vertices");
  }
  PolyMesh mesh() {
    ReadReport report;
    return read_mesh(file("out.obj"), report);
  }
};

TEST_F(OptionEffects, PricesMakeQuadsAndRegularVertices) {
  must("strake sample part -o part.ply --faces 8000");
  const std::string run = "part.ply --vertices 1200 --lines-only ";
  const auto usual = judged(run);
  const auto quads = [](const nlohmann::json& r) -> double {
    return r.at("faces").at("quad_share");
  };
  const auto regular = [](const nlohmann::json& r) -> double {
    return r.at("valence").at("share_4");
  };
  EXPECT_LT(quads(judged(run + "--odd-price 0")), quads(usual) - 0.01);
  EXPECT_LT(regular(judged(run + "--valence-price 0")), regular(usual) - 0.005);
}

// Also where faces cross and lines are traced anew.
TEST_F(OptionEffects, LinesFartherApartGiveFewerVertices) {
  STRAKE_MODELS_OR_SKIP(models);
  const std::string run = (models / "poly/shark.ply").string() + " --spacing-scale ";
  const int usual = vertices(judged(run + "1"));
  for (const std::string scale : {"1.8", "3"}) EXPECT_LT(vertices(judged(run + scale)), usual);
}

TEST_F(OptionEffects, LinesStopWhereOthersAreNear) {
  must("strake sample ellipsoid -o ellipsoid.ply --faces 6000");
  const std::string run = "ellipsoid.ply --spacing-scale 2 --line-flow 0 --stop-fraction ";
  const int soon = vertices(judged(run + "0.9"));
  const int late = vertices(judged(run + "0.1"));
  const int between = vertices(judged(run + "0.5"));
  EXPECT_LT(soon, between);
  EXPECT_LT(between, late);
}

TEST_F(OptionEffects, FewerLinesEndWhereDistancesFollowThem) {
  for (const std::string sample : {"ellipsoid", "hyperboloid"}) {
    must("strake sample " + sample + " -o sample.ply --faces 6000");
    const auto open_lines = [&](const std::string& flow) {
      judged("sample.ply --spacing-scale 1 --line-flow " + flow);
      const auto traced = told_by("trace").at("trace");
      return traced.at("lines").get<int>() - traced.at("closed_lines").get<int>();
    };
    EXPECT_LT(open_lines("5"), open_lines("0")) << sample;
  }
}

TEST_F(OptionEffects, StripsMakeUpForACount) {
  must("strake sample ellipsoid -o ellipsoid.ply --faces 6000");
  const std::string run = "ellipsoid.ply --spacing-scale 2 ";
  const int usual = vertices(judged(run));
  for (const double share : {0.9, 1.2}) {
    const int wanted = static_cast<int>(share * usual);
    const int got = vertices(judged(run + "--strip-vertices " + std::to_string(wanted)));
    EXPECT_LT(std::abs(got - wanted), std::abs(usual - wanted) / 2) << usual << ", " << wanted;
  }
}

TEST_F(OptionEffects, CubesAreTurnedOutwardsAndDivided) {
  put("cube.obj",
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
      "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 6 7 3 2\nf 7 8 4 3\nf 8 5 1 4\n");
  const auto volume = [&]() {
    const PolyMesh made = mesh();
    double sum = 0;
    for (Index f = 0; f < made.face_count(); ++f) {
      const auto face = made.face(f);
      const Vec3& a = made.positions[face[0]];
      for (std::size_t i = 2; i < face.size(); ++i) {
        sum += a.dot(made.positions[face[i - 1]].cross(made.positions[face[i]])) / 6;
      }
    }
    return sum;
  };
  judged("cube.obj");
  EXPECT_NEAR(volume(), -1, 1e-9);
  judged("cube.obj --outwards");
  EXPECT_NEAR(volume(), 1, 1e-9);
  const auto divided = [&](const std::string& option) -> int {
    judged("cube.obj --longest-edge " + option);
    return told_by("import").at("census").at("vertices");
  };
  EXPECT_EQ(divided("100%"), 8);
  // The longest edges are diagonals, 0.816 of the cube's.
  EXPECT_GT(divided("40%"), 8);
  EXPECT_GT(divided("10%"), divided("40%"));
}

/// Share of the edges' length that runs along the guide, within 10 degrees.
TEST_F(OptionEffects, GuidesReachAsFarAsAsked) {
  must("strake sample saddle -o saddle.ply --faces 4000");
  std::string guide;
  std::string line = "l";
  for (int i = 0; i <= 20; ++i) {
    const double x = -0.8 + 0.08 * i;
    const double y = -0.3 + 0.045 * i;
    const double z = kSaddleBend * (x * x - y * y);
    guide += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    line += " " + std::to_string(i + 1);
  }
  put("guide.obj", guide + line + "\n");
  const auto along = [&](const std::string& reach) {
    judged("saddle.ply --guides guide.obj --vertices 900 --guide-reach " + reach);
    const Vec3 way = Vec3(1.6, 0.9, 0).normalized();
    const PolyMesh made = mesh();
    double all = 0;
    double of_guide = 0;
    for (Index f = 0; f < made.face_count(); ++f) {
      const auto face = made.face(f);
      for (std::size_t i = 0; i < face.size(); ++i) {
        Vec3 edge = made.positions[face[(i + 1) % face.size()]] - made.positions[face[i]];
        edge.z() = 0;
        all += edge.norm();
        if (std::abs(edge.dot(way)) > std::cos(0.1745) * edge.norm()) of_guide += edge.norm();
      }
    }
    return of_guide / all;
  };
  const double near = along("1%");
  EXPECT_GT(along("20%"), near + 0.05);
}

}  // namespace
}  // namespace strake::pipeline_test
