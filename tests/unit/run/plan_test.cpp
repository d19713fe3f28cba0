#include "strake/run/plan.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <set>

#include "common/core/error.h"
#include "strake/run/stage_catalog.h"
#include "tests/unit/run/pipeline_file.h"

namespace strake::run_test {
namespace {

class PlanTest : public PipelineFileTest {
 protected:
  [[nodiscard]] Plan plan(const std::string& text, const Selection& selection = {}) const {
    return make_plan(
        describe("version: 1\n"
                 "stages: {evaluate: {inputs: {candidate: quads}}, mesh: {}, trace: {},"
                 " smooth: {}, tensor: {}, import: {}}\n" +
                 text),
        selection);
  }
  static std::string ids(const Plan& plan) {
    std::string all;
    for (const Step& step : plan.steps) all += (all.empty() ? "" : " ") + step.id;
    return all;
  }
  static const Step& step(const Plan& plan, const std::string& id) {
    const auto found = std::find_if(plan.steps.begin(), plan.steps.end(),
                                    [&](const Step& other) { return other.id == id; });
    EXPECT_NE(found, plan.steps.end()) << id << " is not among " << ids(plan);
    return found == plan.steps.end() ? plan.steps.front() : *found;
  }
};

TEST_F(PlanTest, OneModelIsOneChain) {
  EXPECT_EQ(ids(plan("models: [a.obj]\n")), "a.import a.tensor a.smooth a.trace a.mesh a.evaluate");
}

TEST_F(PlanTest, SamplesAreMadeFirst) {
  const Plan made = plan("models: {t: {sample: {kind: torus, faces: 2000}}}\n");
  EXPECT_EQ(ids(made), "t.sample t.import t.tensor t.smooth t.trace t.mesh t.evaluate");
  EXPECT_EQ(step(made, "t.import").inputs.at(0).step, 0u);
}

TEST_F(PlanTest, VariantsShareWhatTheyDoNotChange) {
  const Plan made = plan(
      "models: [a.obj]\nvariants: {x: {}, y: {trace: {seed: 2}}, z: {evaluate: {samples: "
      "5000}}}\n");
  EXPECT_EQ(ids(made),
            "a.import a.tensor a.smooth a.trace.x a.mesh.x a.evaluate.x a.trace.y a.mesh.y "
            "a.evaluate.y a.evaluate.z");
  EXPECT_EQ(step(made, "a.smooth").variants, (std::vector<std::string>{"x", "y", "z"}));
  EXPECT_EQ(step(made, "a.mesh.x").variants, (std::vector<std::string>{"x", "z"}));
}

/// The more specific setting decides which goal holds, not only its value.
TEST_F(PlanTest, AStrongerGoalTakesThePlaceOfAnother) {
  const std::string text =
      "models: {a: {file: a.obj, options: {trace: {faces: 700}}}, b: b.ply}\n"
      "options: {trace: {tolerance: 1%}}\nvariants: {x: {trace: {vertices: 400}}, y: {}}\n";
  const auto goals = [](const Step& step) {
    std::string all;
    for (const auto& option : step_provenance(step).options) {
      const bool is_goal =
          option.name == "tolerance" || option.name == "vertices" || option.name == "faces";
      if (is_goal && !option.value.empty()) all += option.name + " " + option.value;
    }
    return all;
  };
  const Plan made = plan(text);
  EXPECT_EQ(goals(step(made, "a.trace.x")), "vertices 400");
  EXPECT_EQ(goals(step(made, "a.trace.y")), "faces 700");
  EXPECT_EQ(goals(step(made, "b.trace.y")), "tolerance 1%");
  Selection selection;
  selection.settings = {parse_setting(describe("version: 1\n" + text), "trace.tolerance=2%")};
  EXPECT_EQ(goals(step(plan(text, selection), "a.trace")), "tolerance 2%");
  // What is set to nothing asks for nothing, and takes nothing's place.
  selection.settings = {parse_setting(describe("version: 1\n" + text), "trace.faces=")};
  EXPECT_EQ(goals(step(plan(text, selection), "a.trace.x")), "vertices 400");
  EXPECT_EQ(goals(step(plan(text, selection), "b.trace.y")), "tolerance 1%");
}

/// From the first stage that makes something of the wanted size.
TEST_F(PlanTest, ResultsAreAsLargeAsTheyAreWanted) {
  const Plan made = plan(
      "models: [a.obj]\nvariants: {x: {trace: {vertices: 9000}}, y: {trace: {tolerance: 0.1%}}, "
      "z: {trace: {tolerance: 2}}, s: {}}\n");
  EXPECT_EQ(step(made, "a.smooth").vertices, 0);
  EXPECT_EQ(step(made, "a.trace.x").vertices, 9000);
  EXPECT_EQ(step(made, "a.evaluate.x").vertices, 9000);
  EXPECT_EQ(step(made, "a.mesh.y").vertices, vertices_within(0.001));
  // Of model units only the model tells.
  EXPECT_EQ(step(made, "a.mesh.z").vertices, 0);
  EXPECT_EQ(step(made, "a.mesh.s").vertices, 0);
}

/// Marks are filled in where the file has them, not in the name of its folder.
TEST_F(PlanTest, FoldersMayBeNamedLikeMarks) {
  const std::filesystem::path folder = folder_ / "{model}";
  std::filesystem::create_directories(folder);
  std::ofstream(folder / "pipeline.yaml")
      << "version: 1\nmodels: [../a.obj]\noutputs: {quads: '{model}.hdf'}\n";
  const Plan made = make_plan(read_description(folder / "pipeline.yaml"), {});
  EXPECT_EQ(step(made, "a.mesh").deliver_to, (std::vector<std::string>{folder / "a.hdf"}));
}

TEST_F(PlanTest, AWrittenDefaultIsNoOtherVariant) {
  EXPECT_EQ(plan("models: [a.obj]\nvariants: {x: {}, y: {trace: {seed: 1}}}\n").steps.size(), 6u);
}

/// A stage takes a file where its model has one, under the name of the port or another.
TEST_F(PlanTest, StagesTakeTheFilesOfTheirModel) {
  put("lines.obj", "l 1 2\n");
  const auto ports = [&](const Plan& made, const std::string& id) {
    std::string text;
    for (const StepInput& input : step(made, id).inputs) {
      text += input.port + (input.file.empty() ? " " : "=" + input.file.filename().string() + " ");
    }
    return text;
  };
  const std::string models =
      "models: {x: {file: a.obj, inputs: {guides: lines.obj, density: b.ply}}, y: b.ply}\n";
  const Plan made = plan(models);
  EXPECT_EQ(ports(made, "x.import"), "input=a.obj ");
  EXPECT_EQ(ports(made, "x.smooth"), "mesh tensor guides=lines.obj ");
  EXPECT_EQ(ports(made, "x.trace"), "mesh field density=b.ply ");
  EXPECT_EQ(ports(made, "y.smooth"), "mesh tensor ");
  EXPECT_EQ(ports(made, "y.trace"), "mesh field ");
  const Plan wired =
      make_plan(describe("version: 1\nmodels: {x: {file: a.obj, inputs: {flow: lines.obj, "
                         "feature-edges: b.ply}}}\n"
                         "stages: {import: , tensor: , smooth: {inputs: {guides: flow}}, "
                         "trace: {inputs: {density: ~}}}\n"),
                {});
  EXPECT_EQ(ports(wired, "x.import"), "input=a.obj feature-edges=b.ply ");
  EXPECT_EQ(ports(wired, "x.smooth"), "mesh tensor guides=lines.obj ");
  EXPECT_EQ(ports(wired, "x.trace"), "mesh field ");
}

TEST_F(PlanTest, ModelsShareNothing) {
  const Plan made = plan("models: {x: a.obj, y: a.obj}\n");
  EXPECT_EQ(made.steps.size(), 12u);
}

TEST_F(PlanTest, EachStepComesAfterThoseItNeeds) {
  const Plan made = plan(
      "models: [a.obj, b.ply]\nvariants: {x: {trace: {seed: [1, 2, 3]}}, y: {tensor: {radius: 2%}}}"
      "\n"
      "outputs: {quads: ['{model}-{variant}.obj', '{model}-{variant}.hdf']}\n");
  std::set<std::string> ids;
  for (std::size_t s = 0; s < made.steps.size(); ++s) {
    for (const std::size_t need : needs_of(made.steps[s])) EXPECT_LT(need, s);
    EXPECT_TRUE(ids.insert(made.steps[s].id).second) << made.steps[s].id;
  }
}

TEST_F(PlanTest, StrongerSettingsWin) {
  const std::string text =
      "models:\n  m: {file: a.obj, options: {trace: {seed: 3}}}\n  n: b.ply\n"
      "options: {trace: {seed: 2}}\nvariants: {v: {}, w: {trace: {seed: 4}}}\n";
  const auto seed = [&](const Plan& made, const std::string& id) {
    return step_provenance(step(made, id)).options;
  };
  const auto value = [](const std::vector<Provenance::OptionRecord>& options) {
    for (const auto& option : options) {
      if (option.name == "seed") return option.value;
    }
    return std::string();
  };
  const Plan made = plan(text);
  EXPECT_EQ(value(seed(made, "m.trace.v")), "3");
  EXPECT_EQ(value(seed(made, "n.trace.v")), "2");
  EXPECT_EQ(value(seed(made, "m.trace.w")), "4");
  Selection selection;
  selection.settings = {{"trace", "seed", "9", {}}};
  const Plan forced = plan(text, selection);
  EXPECT_EQ(value(seed(forced, "m.trace")), "9") << "all variants are the same now";
}

TEST_F(PlanTest, OutputsGoToTheStepThatGivesThem) {
  const Plan made =
      plan("models: [a.obj]\noutputs: {quads: [x.hdf, x.obj, y.obj, x.off], report: x.json}\n");
  const auto file = [&](const char* name) { return (folder_ / name).string(); };
  EXPECT_EQ(step(made, "a.mesh").deliver_to, std::vector<std::string>{file("x.hdf")});
  EXPECT_EQ(step(made, "a.export.obj").deliver_to,
            (std::vector<std::string>{file("x.obj"), file("y.obj")}));
  EXPECT_EQ(step(made, "a.export.off").deliver_to, std::vector<std::string>{file("x.off")});
  EXPECT_EQ(step(made, "a.evaluate").deliver_to, std::vector<std::string>{file("x.json")});
}

TEST_F(PlanTest, AnOutputIsNotThePipeline) {
  put("p.json", R"({"version": 1, "models": ["a.obj"], "outputs": {"report": "p.json"}})");
  try {
    make_plan(read_description(folder_ / "p.json"), {});
    ADD_FAILURE() << "was accepted";
  } catch (const UsageError& error) {
    EXPECT_NE(std::string(error.what()).find("is the pipeline file"), std::string::npos);
  }
}

/// It would work once: the next run would take the output for a model.
TEST_F(PlanTest, AnOutputIsNoModelOfTheNextRun) {
  const auto said = [&](const std::string& patterns, const std::string& output) {
    return complaint("version: 1\nmodels: [" + patterns + "]\noutputs: {fitted: \"" + output +
                     "\"}\n");
  };
  EXPECT_NE(said("'*.obj'", "{model}-quads.obj").find("/a-quads.obj' would be a model"),
            std::string::npos);
  EXPECT_NE(said("b.ply, './*.obj'", "{model}-quads.obj").find("'./*.obj' in 'models' matches"),
            std::string::npos);
  std::filesystem::create_directory(folder_ / "out");
  put("out/c.obj", "v 0 0 0\n");
  EXPECT_NE(said("'*/*.obj'", "out/../out/{model}-quads.obj").find("another folder"),
            std::string::npos);
  EXPECT_FALSE(plan("models: ['*.obj']\noutputs: {quads: ['out/{model}.obj', '{model}.ply', "
                    "'.{model}.obj']}\n")
                   .steps.empty());
  std::filesystem::remove_all(folder_ / "out");
}

TEST_F(PlanTest, LinksToAModelAreTheModel) {
  std::filesystem::create_symlink(".", folder_ / "self");
  std::filesystem::create_symlink("a.obj", folder_ / "link.obj");
  for (const char* output : {"self/a.obj", "link.obj"}) {
    const std::string text =
        "version: 1\nmodels: [a.obj]\noutputs: {fitted: " + std::string(output);
    EXPECT_NE(complaint(text + "}\n").find("is the model 'a'"), std::string::npos) << output;
  }
  const std::string twice = "outputs: {fitted: b.obj, quads: self/b.obj}\n";
  EXPECT_NE(complaint("version: 1\nmodels: [a.obj]\n" + twice).find("would be written twice"),
            std::string::npos);
  std::filesystem::remove(folder_ / "self");
  std::filesystem::remove(folder_ / "link.obj");
}

TEST_F(PlanTest, WhatIsEvaluatedIsTheLastResult) {
  const auto evaluated = [&](const std::string& more) {
    const Plan made = make_plan(
        describe("version: 1\nmodels: [a.obj]\nstages: {import: {}, tensor: {}, smooth: {}, "
                 "trace: {}, mesh: {}, evaluate: {}" +
                 more + "}\n"),
        {});
    for (const StepInput& input : step(made, "a.evaluate").inputs) {
      if (input.port == "candidate") return made.steps[input.step].rule;
    }
    return std::string();
  };
  EXPECT_EQ(evaluated(""), "mesh");
  EXPECT_EQ(evaluated(", fit: {}"), "fit");
  EXPECT_EQ(evaluated(", fit: {}, refine: {}"), "refine");
  EXPECT_NE(complaint("version: 1\nmodels: [a.obj]\nstages: {import: {}, tensor: {}, smooth: {}, "
                      "trace: {}, mesh: {}, fit: {}, refine: {}, refine-worst: {}, evaluate: {}}\n")
                .find("may take any of refined, improved"),
            std::string::npos);
}

TEST_F(PlanTest, NamesOfOutputsMayEndInCapitals) {
  const Plan made = plan("models: [a.obj]\noutputs: {quads: [X.OBJ, X.HDF]}\n");
  const auto file = [&](const char* name) { return (folder_ / name).string(); };
  EXPECT_EQ(step(made, "a.export.obj").deliver_to, std::vector<std::string>{file("X.OBJ")});
  EXPECT_EQ(step(made, "a.mesh").deliver_to, std::vector<std::string>{file("X.HDF")});
}

TEST(StageCatalog, StagesOfOtherVersionsAreToldOf) {
  EXPECT_EQ(make_stage("trace").name, "trace");
  EXPECT_THROW(make_stage("nope"), InputError);
}

TEST_F(PlanTest, UntilLeavesOutWhatComesAfterAndBeside) {
  Selection selection;
  selection.until = "trace";
  EXPECT_EQ(ids(plan("models: [a.obj]\noutputs: {quads: x.obj}\n", selection)),
            "a.import a.tensor a.smooth a.trace");
}

TEST_F(PlanTest, TargetsAreModelsAndTheirVariants) {
  const std::string text = "models: [a.obj, b.ply]\nvariants: {x: {}, y: {trace: {seed: 2}}}\n";
  Selection selection;
  selection.targets = {"b/y"};
  EXPECT_EQ(ids(plan(text, selection)), "b.import b.tensor b.smooth b.trace b.mesh b.evaluate");
  for (const char* bad : {"c", "a/z", "a/", "/x", ""}) {
    selection.targets = {bad};
    EXPECT_THROW((void)plan(text, selection), UsageError) << bad;
  }
}

TEST_F(PlanTest, LongNamesMakeFileNamesThatFit) {
  const std::string name(100, 'm');
  const std::string variant(99, 'v');
  const Plan made = plan("models: {" + name + ": a.obj}\nvariants: {" + variant + "1: {}, " +
                         variant + "2: {trace: {seed: 2}}}\n");
  std::set<std::string> ids;
  for (const Step& each : made.steps) {
    EXPECT_LE(each.id.size(), 200u);
    ids.insert(each.id);
  }
  EXPECT_EQ(ids.size(), 9u);
}

TEST_F(PlanTest, FilesOfOtherModelsMayBeMissing) {
  put("density.ply", "ply\n");
  const Description description = describe(
      "version: 1\nmodels: {a: a.obj, gone: gone.obj, lacks: {file: b.ply, inputs: {density: "
      "gone.ply}}}\n");
  const Plan plan = make_plan(description, {{"a"}, {}, {}});
  EXPECT_FALSE(plan.steps.empty());
  EXPECT_TRUE(plan.left_out.empty());
  for (const std::string model : {"gone", "lacks"}) {
    EXPECT_THROW(make_plan(description, {{model}, {}, {}}), UsageError);
  }
  EXPECT_THROW(make_plan(description, {}), UsageError);
  const Plan all = make_plan(description, {{}, {}, {}, true});
  EXPECT_EQ(all.steps.size(), plan.steps.size());
  EXPECT_EQ(all.left_out.size(), 2u);
  EXPECT_EQ(all.left_out.at("lacks"), folder_ / "gone.ply");
}

}  // namespace
}  // namespace strake::run_test
