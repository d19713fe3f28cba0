#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <tuple>

#include "common/artifact/artifact.h"
#include "common/artifact/meshfile/mesh_reader.h"
#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

class FrontEnd : public ProgramTest {
 protected:
  FrontEnd() { must("strake sample torus -o torus.ply --faces 8000"); }
  PolyMesh read(const std::string& name) {
    ReadReport report;
    return read_mesh(file(name), report);
  }
};

TEST_F(FrontEnd, RemeshesWithNothingButNames) {
  const std::string summary = must("strake remesh torus.ply -o out.obj");
  EXPECT_NE(summary.find("out.obj"), std::string::npos);
  EXPECT_NE(summary.find("oriented manifold, that of the input after repairs"), std::string::npos)
      << summary;
  must("strake check out.obj --max-sides 5");
}

TEST_F(FrontEnd, WritesTheSameMeshInEveryFormat) {
  for (const char* name : {"out.obj", "out.ply", "out.off", "out.hdf"}) {
    must(std::string("strake remesh torus.ply -q --no-evaluate -o ") + name);
  }
  const PolyMesh expected = read_quad_mesh(file("out.hdf")).mesh;
  for (const char* name : {"out.obj", "out.ply", "out.off"}) {
    const PolyMesh mesh = read(name);
    EXPECT_EQ(mesh.positions, expected.positions) << name;
    EXPECT_EQ(mesh.corners, expected.corners) << name;
    EXPECT_EQ(mesh.offsets, expected.offsets) << name;
  }
}

TEST_F(FrontEnd, MeetsAWantedCount) {
  for (const int wanted : {400, 1500}) {
    const std::string count = std::to_string(wanted);
    must("strake remesh torus.ply -q --no-evaluate -o v.obj --vertices " + count);
    must("strake remesh torus.ply -q --no-evaluate -o f.obj --faces " + count);
    EXPECT_NEAR(read("v.obj").vertex_count(), wanted, 0.05 * wanted);
    EXPECT_NEAR(read("f.obj").face_count(), wanted, 0.05 * wanted);
  }
}

/// Values that the search for the count leaves behind are nobody's wish.
TEST_F(FrontEnd, SaysOfResultsWhatWasAskedFor) {
  must("strake remesh torus.ply -q --no-evaluate -o out.hdf --vertices 400 --seed 7");
  const std::string told = run("strake info out.hdf").out;
  for (const char* part : {"--vertices 400\n", "--seed 7\n", "--spacing-scale (none)  (default)",
                           "--refine-vertices (none)  (default)"}) {
    EXPECT_NE(told.find(part), std::string::npos) << part << " in\n" << told;
  }
}

/// Measured by the judge of the stage evaluate, both ways.
TEST_F(FrontEnd, KeepsAToleranceOrSaysWhereNot) {
  for (const char* tolerance : {"0.05%", "0.4%"}) {
    const std::string option = std::string(" --tolerance ") + tolerance;
    must("strake remesh torus.ply -q -o out.obj --report report.json" + option);
    must("strake check out.obj --max-sides 5");
    const auto reports = nlohmann::json::parse(bytes("report.json"));
    const auto& distance = reports.at("evaluate").at("result").at("distance");
    EXPECT_LE(distance.at("max_share").get<double>(), Length::parse(tolerance).value);
    // It would have been an error.
    const auto& asked = reports.at("evaluate").at("options").at("evaluate-tolerance");
    EXPECT_EQ(Length::parse(asked.at("value").get<std::string>()), Length::parse(tolerance));
  }
  must_fail(
      6,
      "strake remesh torus.ply -q -o bad.obj --tolerance 0.1% --refine-rounds 0 --spacing-scale 3",
      "from the surface");
}

/// A mesh that is coarser than the tolerance is the polyhedron it is: here a roof that is
/// bent by 18 degrees, less than a crease.
TEST_F(FrontEnd, KeepsTheRidgesOfCoarseMeshes) {
  put("roof.obj",
      "v 0 0 0\nv 1 0 0.1584\nv 2 0 0\nv 0 3 0\nv 1 3 0.1584\nv 2 3 0\n"
      "f 1 2 5 4\nf 2 3 6 5\n");
  const std::string flags = " -q --no-evaluate -o out.obj --report report.json --tolerance 0.3%";
  const auto result = [&](const std::string& stage) {
    return nlohmann::json::parse(bytes("report.json")).at(stage).at("result");
  };
  must("strake remesh roof.obj" + flags);
  EXPECT_EQ(result("import").at("features").at("ridge_edges"), 1);
  for (const Vec3& p : read("out.obj").positions) {
    EXPECT_NEAR(p.z(), 0.1584 * (1 - std::abs(p.x() - 1)), 1e-6);
  }
  for (const std::string without : {"--feature-height 100%", "--feature-angle 180"}) {
    must("strake remesh roof.obj " + without + flags);
    EXPECT_EQ(result("import").at("features").at("ridge_edges"), 0) << without;
  }
}

TEST_F(FrontEnd, KeepsToTheMostSides) {
  for (const std::string goal : {"--vertices 300", "--tolerance 0.2%"}) {
    must("strake remesh torus.ply -q -o out.obj --max-sides 4 " + goal);
    must("strake check out.obj --max-sides 4");
  }
}

TEST_F(FrontEnd, AFolderHoldsTheLastRunAlone) {
  must("strake remesh torus.ply -q -o out.obj --keep kept --vertices 400");
  EXPECT_TRUE(std::filesystem::exists(file("kept/refined.hdf")));
  put("kept/mine.txt", "a note");
  must("strake remesh torus.ply -q -o out.obj --keep kept --no-evaluate --feedback-rounds 0");
  for (const char* gone : {"refined.hdf", "refine.json", "evaluate.json"}) {
    EXPECT_FALSE(std::filesystem::exists(file("kept") / gone)) << gone;
  }
  EXPECT_TRUE(std::filesystem::exists(file("kept/lines.hdf")));
  EXPECT_EQ(bytes("kept/mine.txt"), "a note");
}

TEST_F(FrontEnd, RefusesOptionsThatContradictEachOther) {
  const auto refused = [&](const std::string& options, const std::string& said) {
    must_fail(kUsage, "strake remesh torus.ply -o q.obj " + options, said);
    EXPECT_FALSE(std::filesystem::exists(file("q.obj"))) << options;
  };
  refused("--tolerance 0.3% --refine-tolerance 0.1%", "strake-refine; give --tolerance");
  refused("--refine-tolerance 0.1%", "strake-refine; give --tolerance");
  refused("--vertices 300 --refine-vertices 400", "strake-refine; give");
  refused("--vertices 300 --decimate-vertices 400", "strake-decimate; give");
  refused("--vertices 300 --coarse-vertices 4000", "strake-coarsen; give");
  refused("--vertices 300 --refine-partly", "misses a --tolerance");
  refused("--no-evaluate --evaluate-tolerance 0.1%", "--no-evaluate");
  refused("--vertices 300 --max-spacing 0.2%", "and 300 are wanted");
}

/// What steers lines only is not proven; what comes of it is told.
TEST_F(FrontEnd, SaysWhereAToleranceThatOnlySteersIsMissed) {
  must("strake sample part -o part.ply --faces 6000");
  const Outcome missed = run("strake remesh part.ply -o q.obj --tolerance 0.05% --pure-quads");
  EXPECT_EQ(missed.exit_code, 0);
  EXPECT_NE(missed.err.find("more than the tolerance of"), std::string::npos) << missed.err;
}

/// A short line between cells that are far larger.
TEST_F(FrontEnd, SaysWhereListedEdgesAreLost) {
  std::string grid;
  for (int y = 0; y <= 40; ++y) {
    for (int x = 0; x <= 40; ++x) {
      grid += "v " + std::to_string(x) + " " + std::to_string(y) + " " +
              std::to_string(0.02 * (x * x + y * y) / 10) + "\n";
    }
  }
  for (int y = 0; y < 40; ++y) {
    for (int x = 0; x < 40; ++x) {
      const int v = 41 * y + x + 1;
      grid += "f " + std::to_string(v) + " " + std::to_string(v + 1) + " " +
              std::to_string(v + 42) + " " + std::to_string(v + 41) + "\n";
    }
  }
  put("grid.obj", grid);
  put("edges.txt", std::to_string(41 * 20 + 20) + " " + std::to_string(41 * 20 + 21) + "\n");
  const Outcome lost =
      run("strake remesh grid.obj -o q.obj --vertices 60 --feature-edges edges.txt");
  EXPECT_EQ(lost.exit_code, 0) << lost.err;
  EXPECT_NE(lost.err.find("of the length of feature lines"), std::string::npos) << lost.err;
}

/// A run that comes to nothing leaves what an earlier one kept.
TEST_F(FrontEnd, AFolderStaysUntilThereIsSomethingToKeep) {
  must("strake remesh torus.ply -q -o out.obj --keep kept --vertices 400");
  const std::string mesh = bytes("kept/mesh.hdf");
  put("broken.obj", "v 0 0 0\nnothing else\n");
  must_fail(kBadInput, "strake remesh missing.obj -o q.obj --keep kept", "missing.obj");
  must_fail(kBadInput, "strake remesh broken.obj -o q.obj --keep kept", "broken.obj");
  must_fail(kUsage, "strake remesh torus.ply -o q.obj --keep kept --seed x", "seed");
  for (const char* kept : {"import.json", "refined.hdf", "fitted.hdf", "evaluate.json"}) {
    EXPECT_TRUE(std::filesystem::exists(file("kept") / kept)) << kept;
  }
  EXPECT_EQ(bytes("kept/mesh.hdf"), mesh);
}

/// Neither files of the same command nor those of somebody else are replaced.
TEST_F(FrontEnd, AFolderIsNotThatOfOtherFiles) {
  must("strake remesh torus.ply -q -o out.obj --keep kept --vertices 400");
  const std::string fitted = bytes("kept/fitted.hdf");
  must_fail(kUsage, "strake remesh kept/fitted.hdf -o q.obj --keep kept", "the input");
  must_fail(kUsage, "strake remesh torus.ply -o kept/mesh.hdf --keep kept", "the output");
  for (const std::string name : {"trace", "times"}) {
    must_fail(kUsage,
              "strake remesh torus.ply -o q.obj --report kept/" + name + ".json --keep kept",
              "the report");
  }
  EXPECT_EQ(bytes("kept/fitted.hdf"), fitted);
  std::filesystem::create_directory(file("own"));
  put("own/size.hdf", "mine");
  must_fail(kUsage, "strake remesh torus.ply -o q.obj --keep own", "size.hdf");
  for (const std::string times : {"", "{\"seconds\": {\"import\": 1}}", "{\"laps\": [1, 2]}"}) {
    put("own/times.json", times);
    must_fail(kUsage, "strake remesh torus.ply -o q.obj --keep own", "not that of a kept run");
    EXPECT_EQ(bytes("own/times.json"), times);
  }
  EXPECT_EQ(bytes("own/size.hdf"), "mine");
  std::filesystem::remove(file("own/size.hdf"));
  must_fail(kUsage, "strake remesh torus.ply -o q.obj --keep own", "has 'times.json'");
  EXPECT_FALSE(std::filesystem::exists(file("q.obj")));
}

TEST_F(FrontEnd, TakesAnyRatioOfTheWorkingMesh) {
  must("strake remesh torus.ply -q --no-evaluate -o out.obj --vertices 100 --working-ratio 0.01");
}

/// Of a sphere whose upper half is wanted twice as dense.
TEST_F(FrontEnd, FollowsADensity) {
  constexpr double kLineDistance = 0.15;
  must("strake sample sphere -o sphere.ply --faces 8000");
  const PolyMesh sphere = read("sphere.ply");
  std::string text = "ply\nformat ascii 1.0\nelement vertex " +
                     std::to_string(sphere.vertex_count()) +
                     "\nproperty float density\nend_header\n";
  for (const Vec3& p : sphere.positions) text += p.z() > 0 ? "2\n" : "1\n";
  put("density.ply", text);
  // Single runs are up to a fifth off: on coarse results a line more or less counts.
  const std::array<int, 12> counts = {600,  700,  800,  900,  1000, 1100,
                                      1200, 1300, 1400, 1500, 1750, 2000};
  double mean = 0;
  double mean_off_border = 0;
  for (const int vertices : counts) {
    must("strake remesh sphere.ply -q --no-evaluate -o out.obj --density density.ply --vertices " +
         std::to_string(vertices));
    const std::vector<Vec3> positions = read("out.obj").positions;
    const auto ratio = [&](double least_distance) {
      double upper = 0;
      double lower = 0;
      for (const Vec3& p : positions) {
        if (std::abs(p.z()) >= least_distance) (p.z() > 0 ? upper : lower) += 1;
      }
      return upper / lower;
    };
    EXPECT_GT(ratio(0), 1.5) << vertices;
    mean += ratio(0) / counts.size();
    mean_off_border += ratio(kLineDistance) / counts.size();
  }
  EXPECT_NEAR(mean, 2, 0.2);  // lines go on a little into the other half, or along the border
  EXPECT_NEAR(mean_off_border, 2, 0.2);  // 0.05 by chance, at other seeds 2.02 and 2.08
  must_fail(4, "strake remesh torus.ply -o bad.obj --density density.ply", "of that file");
  put("density.ply",
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float density\nend_header\n1\n");
  must_fail(4, "strake remesh torus.ply -o bad.obj --density density.ply",
            "the density has 1 vertices");
  must_fail(4, "strake remesh torus.ply -o bad.obj --vertices 500 --density density.ply",
            "the density has 1 vertices");
  must_fail(3, "strake remesh torus.ply -o bad.obj --density torus.ply",
            "no vertex property 'density'");
}

/// Cells of 300 vertices on a sphere cannot be eight times smaller on one side of a circle.
TEST_F(FrontEnd, SaysHowFarADensityIsFollowed) {
  must("strake sample sphere -o sphere.ply --faces 4000");
  const PolyMesh sphere = read("sphere.ply");
  const auto say = [&](const std::string& upper) {
    std::string text = "ply\nformat ascii 1.0\nelement vertex " +
                       std::to_string(sphere.vertex_count()) +
                       "\nproperty float density\nend_header\n";
    for (const Vec3& p : sphere.positions) text += p.z() > 0 ? upper : "1\n";
    put("density.ply", text);
    return run("strake remesh sphere.ply --no-evaluate -o out.obj --density density.ply "
               "--vertices 300")
        .err;
  };
  EXPECT_NE(say("64\n").find("warning: the density is followed for"), std::string::npos);
  EXPECT_EQ(say("1\n").find("warning: the density"), std::string::npos);
}

/// A density says where vertices are to lie in a flat, whether it differs or not.
TEST_F(FrontEnd, FlatsAreSpreadEvenlyButForADensity) {
  must("strake sample plane -o plane.ply --faces 2000");
  std::string text = "ply\nformat ascii 1.0\nelement vertex ";
  const std::size_t count = read("plane.ply").positions.size();
  text += std::to_string(count) + "\nproperty float density\nend_header\n";
  for (std::size_t v = 0; v < count; ++v) text += v % 2 == 0 ? "1\n" : "1.5\n";
  put("density.ply", text);
  const std::string flags = "strake remesh plane.ply -q --no-evaluate --vertices 200 ";
  must(flags + "-o even.obj");
  must(flags + "--keep-flats -o kept.obj");
  EXPECT_NE(bytes("even.obj"), bytes("kept.obj"));
  must(flags + "--density density.ply -o dense.obj");
  must(flags + "--density density.ply --keep-flats -o dense-kept.obj");
  EXPECT_EQ(bytes("dense.obj"), bytes("dense-kept.obj"));
}

/// Guides by the real programs; what they do to the result is a test of the stage smooth.
TEST_F(FrontEnd, FollowsGuides) {
  put("guides.obj", "v 1.4 0 0\nv 1.34 0.2 0.2\nv 1.2 0.3 0.32\nl 1 2 3\n");
  const std::string flags = " -q --no-evaluate --vertices 800 ";
  must("strake remesh torus.ply -o plain.obj" + flags);
  must("strake remesh torus.ply -o out.obj --keep k --report report.json --guides guides.obj" +
       flags);
  EXPECT_NE(bytes("out.obj"), bytes("plain.obj"));
  const auto report = nlohmann::json::parse(bytes("report.json"));
  EXPECT_EQ(report.at("smooth").at("result").at("smooth").at("guides"), 1);
  // The stages one by one give the same, and the guides are part of what the field was made from.
  must("strake-smooth k/mesh.hdf k/tensor.hdf -o field.hdf -q --guides guides.obj");
  EXPECT_EQ(bytes("field.hdf"), bytes("k/field.hdf"));
  EXPECT_NE(must("strake info field.hdf").find("from guides"), std::string::npos);
  must("strake check field.hdf");

  must_fail(3, "strake remesh torus.ply -o bad.obj --guides none.obj", "none.obj");
  must_fail(2, "strake remesh torus.ply -o bad.obj --extension paper --guides guides.obj",
            "--extension paper");
  const std::vector<std::pair<std::string, std::string>> files = {
      {"v 1.4 0 0\nv 1.34 0.2 0.2\n", "no guide line"},
      {"v 1.4 0 0\nv nan 0.2 0.2\nl 1 2\n", "no finite number, at vertex 2"},
      {"v 1.4 0 0\nv 0 0 0\nl 1 2\n", "from the surface, more than 2 %"},
      {"v 1.4 0 0\nl 1 2\n", "names vertex 2 in guide 1"}};
  for (const auto& [text, message] : files) {
    put("guides.obj", text);
    must_fail(3, "strake remesh torus.ply -o bad.obj --guides guides.obj", message);
    must_fail(3, "strake-smooth k/mesh.hdf k/tensor.hdf -o bad.hdf --guides guides.obj", message);
  }
}

TEST_F(FrontEnd, WarnsWhereACountIsOutOfReach) {
  const Outcome outcome = run("strake remesh torus.ply --no-evaluate -o v.obj --vertices 4");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("warning: 4 vertices were wanted"), std::string::npos) << outcome.err;
}

TEST_F(FrontEnd, QuietSaysNothing) {
  const Outcome outcome = run("strake remesh torus.ply -o out.obj -q");
  EXPECT_EQ(outcome.exit_code, 0);
  EXPECT_EQ(outcome.out + outcome.err, "");
  must("strake-import torus.ply -o mesh.hdf -q");
  const Outcome measured = run("strake-evaluate mesh.hdf out.obj -o report.json -q");
  EXPECT_EQ(measured.exit_code, 0);
  EXPECT_EQ(measured.out + measured.err, "");
}

TEST_F(FrontEnd, LogsAsOneJsonObjectALine) {
  std::istringstream log(run("strake remesh torus.ply -o out.obj --log-json").err);
  std::set<std::string> labels;
  for (std::string line; std::getline(log, line);) {
    const auto event = nlohmann::json::parse(line);
    if (event.at("event") != "progress") continue;
    labels.insert(event.at("label"));
    EXPECT_GE(event.at("fraction"), 0.0);
    EXPECT_LE(event.at("fraction"), 1.0);
  }
  EXPECT_EQ(labels, (std::set<std::string>{"strake", "import", "tensor", "smooth", "trace", "size",
                                           "mesh", "refine", "refine-worst", "fit", "evaluate"}));
}

TEST_F(FrontEnd, LogsErrorsAsJsonToo) {
  for (const auto& [command, label, code, part] :
       {std::tuple{"strake remesh torus.ply -o out.obj --log-json --vertices 2", "strake", 2,
                   "--vertices"},
        {"strake remesh none.ply -o out.obj --log-json", "strake", 3, "none.ply"},
        {"strake-import torus.ply -o out.hdf --log-json --strct", "strake-import", 2,
         "--strict"}}) {
    const Outcome outcome = run(command);
    EXPECT_EQ(outcome.exit_code, code);
    const std::string last = outcome.err.substr(outcome.err.rfind('{'));
    const auto event = nlohmann::json::parse(last);
    EXPECT_EQ(event.at("event"), "error");
    EXPECT_EQ(event.at("label"), label);
    EXPECT_EQ(event.at("code"), code);
    EXPECT_NE(event.at("message").get<std::string>().find(part), std::string::npos) << last;
  }
}

TEST_F(FrontEnd, ReportHoldsEveryStage) {
  must("strake remesh torus.ply -o out.obj -q --report report.json");
  const std::string report = bytes("report.json");
  for (const char* stage : {"import", "tensor", "smooth", "trace", "mesh", "fit", "evaluate"}) {
    EXPECT_NE(report.find("\"stage\": \"" + std::string(stage) + "\""), std::string::npos) << stage;
  }
}

TEST_F(FrontEnd, TellsItsVersionAndOptions) {
  EXPECT_EQ(must("strake --version").find("strake "), 0u);
  EXPECT_EQ(must("strake-trace --version").find("strake-trace "), 0u);
  const std::string help = must("strake remesh --help");
  for (const char* option : {"--tolerance", "--vertices", "--feature-angle", "--seed", "--radius",
                             "--threads", "--keep"}) {
    EXPECT_NE(help.find(option), std::string::npos) << option;
  }
}

}  // namespace
}  // namespace strake::pipeline_test
