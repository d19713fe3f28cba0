#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <set>

#include "tests/pipeline/run_program.h"

namespace strake::pipeline_test {
namespace {

using RenderRun = ProgramTest;

TEST_F(RenderRun, AModelIsNotReplacedByItsPicture) {
  must("strake sample part -o part.ply --faces 500");
  const std::string part = bytes("part.ply");
  must_fail(kUsage, "strake-render part.ply -o part.ply", ".png");
  must_fail(kUsage, "strake-render part.ply -o part.jpg", ".png");
  std::filesystem::rename(file("part.ply"), file("part.png"));
  must_fail(kUsage, "strake-render part.png -o part.png", "is the input");
  EXPECT_EQ(bytes("part.png"), part);
  EXPECT_FALSE(std::filesystem::exists(file("part.jpg")));
}

TEST_F(RenderRun, LinesMayBeginWithAByteOrderMark) {
  must("strake sample part -o part.ply --faces 500");
  const std::string lines = "v 0 0 0\nv 1 0 0\nl 1 2\n";
  put("plain.obj", lines);
  put("marked.obj", "\xEF\xBB\xBF" + lines);
  for (const std::string name : {"plain", "marked"}) {
    must("strake-render part.ply -o " + name + ".png --size 64x64 --samples 1 --lines " + name +
         ".obj");
  }
  EXPECT_EQ(bytes("plain.png"), bytes("marked.png"));
}

TEST_F(RenderRun, ANameThatNoFileCanHaveIsBadInput) {
  must_fail(kBadInput, "strake-render " + std::string(300, 'x') + " -o x.png", "xxx");
}

TEST_F(RenderRun, CamerasThatAreNowhereAreRefused) {
  must("strake sample part -o part.ply --faces 500");
  const std::string draw = "strake-render part.ply -o part.png --size 64x64 --samples 1 ";
  for (const std::string wrong :
       {"--azimuth nan", "--azimuth inf", "--azimuth 1e308", "--elevation nan", "--elevation 91",
        "--zoom nan", "--line-width nan", "--edge-width nan", "--target 1e300,0,0",
        "--target=-1e12,0,0", "--target nan,0,0"}) {
    must_fail(kUsage, draw + wrong, wrong.substr(0, wrong.find_first_of(" =")));
  }
  must(draw + "--azimuth -360 --elevation 90 --zoom 1e6 --target 1000,0,0");
}

TEST_F(RenderRun, DrawsEachLayerOfARunAndAgreesWithTheAddressOfAView) {
  must("strake sample part -o part.ply --faces 2000");
  must("strake remesh part.ply -q -o part.obj --vertices 400 --keep run");
  const auto picture = [&](const std::string& options) {
    must("strake-render run -o run.png --size 120x90 --samples 1 " + options);
    return bytes("run.png");
  };
  std::set<std::string> seen;
  for (const std::string options :
       {"--layers edges", "--layers none", "--colour plain", "--colour distance",
        "--colour alignment", "--section y,0.5", "--section y,0.5,flipped", "--layers triangles",
        "--surface input --colour plain --layers minimum",
        "--surface input --colour plain --layers maximum", "--surface input --layers feature",
        "--surface input --colour plain --layers ends",
        "--surface input --colour plain --layers seeds",
        "--surface input --colour plain --layers principal",
        "--surface input --colour plain --layers cross",
        "--surface input --colour plain --layers edges", "--surface input --colour k_min",
        "--surface input --colour k_max", "--surface input --colour confidence"}) {
    EXPECT_TRUE(seen.insert(picture(options)).second) << options << " looks like another one";
  }
  EXPECT_EQ(
      picture("--surface input --colour k_max --layers minimum+edges --section x,0.4"),
      picture(
          "--view 'report.html#tab=surface&a=0,input,k_max,sides,minimum+edges&section=x,0.4'"));
  EXPECT_EQ(picture("--view '#camera=0.5,0.4,0.9,0,0,0'"),
            picture("--view '#camera=0.5,0.4,0.9,0,0,0'"));
  EXPECT_NE(picture("--view '#camera=0.5,0.4,0.9,0,0,0'"),
            picture("--view '#camera=-0.5,0.4,0.9,0,0,0'"));

  // The target is a place of the model, as in pictures of files.
  double x = 0;
  double y = 0;
  double z = 0;
  const std::string result = bytes("part.obj");
  ASSERT_EQ(std::sscanf(result.c_str() + result.find("\nv ") + 3, "%lf %lf %lf", &x, &y, &z), 3);
  const auto close = [&](double to_x) {
    return picture(fmt::format("--zoom 20 --target={},{},{}", to_x, y, z));
  };
  EXPECT_EQ(close(x + 900), close(x + 999)) << "there is something to see";
  EXPECT_NE(close(x), close(x + 999));

  for (const std::string wrong :
       {"--colour k_max", "--surface moon", "--layers edges+moon", "--section w,1",
        "--view '#camera=1,2'", "--surface input --colour colours", "--colour labels"}) {
    EXPECT_EQ(run("strake-render run -o wrong.png " + wrong).exit_code, 2) << wrong;
  }
  for (const std::string wrong : {"--section y,2", "--section y,-0.1", "--section y,nan",
                                  "--section y,0.5,3", "--view '#camera=1e300,0,0,0,0,0'"}) {
    EXPECT_EQ(run("strake-render run -o wrong.png --size 64x64 " + wrong).exit_code, 2) << wrong;
  }
  std::filesystem::create_directory(file("empty"));
  must_fail(3, "strake-render empty -o wrong.png", "no artifact of kind 'quads'");
  EXPECT_FALSE(std::filesystem::exists(file("wrong.png")));
}

TEST_F(RenderRun, LabelsHaveColours) {
  // Two squares side by side, of four triangles each.
  put("squares.obj",
      "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\nv 0.5 0.5 0\nv 1.5 0.5 0\n"
      "g left\nf 1 2 7\nf 2 5 7\nf 5 4 7\nf 4 1 7\n"
      "g right\nf 2 3 8\nf 3 6 8\nf 6 5 8\nf 5 2 8\n");
  must("strake remesh squares.obj -q -o quads.obj --attribute-features labels --keep run");
  const auto picture = [&](const std::string& colour) {
    must("strake-render run -o run.png --size 120x90 --samples 1 --colour " + colour);
    return bytes("run.png");
  };
  EXPECT_NE(picture("labels"), picture("plain"));
}

}  // namespace
}  // namespace strake::pipeline_test
