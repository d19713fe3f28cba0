#include "strake/run/description.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "common/core/error.h"
#include "strake/run/run_paths.h"
#include "tests/unit/run/pipeline_file.h"

namespace strake::run_test {
namespace {

namespace fs = std::filesystem;

/// A file with something wrong, where it is, and a part of what must be said about it.
struct Fault {
  const char* name;
  std::string text;
  const char* place;  ///< "line:column: "
  const char* part;
};

std::ostream& operator<<(std::ostream& stream, const Fault& fault) { return stream << fault.name; }

const Fault kFaults[] = {
    // As a file.
    {"Empty", "", "1:1: ", "'version: 1' is missing"},
    {"OnlyAComment", "# nothing\n", "1:1: ", "'version: 1' is missing"},
    {"NotYaml", "version: 1\nmodels: [a.obj\n", "3:1: ", "no YAML"},
    {"Tabs", "version: 1\nmodels:\n\tx: a.obj\n", "3:3: ", "no YAML"},
    {"Text", "just words\n", "1:1: ", "'key: value'"},
    {"List", "- a.obj\n", "1:1: ", "'key: value'"},
    {"CommaOutsideOfEverything", ", a\n", "1:1: ", "second document"},
    {"TwoDocuments", "version: 1\nmodels: [a.obj]\n---\nversion: 1\n", "3:1: ", "second document"},
    {"UnknownAnchor", "version: 1\nmodels: *x\n", "2:9: ", "no YAML"},
    {"KeyIsAList", "? [a]\n: 1\n", "1:3: ", "a name"},
    {"NoKey", "version: 1\n: a.obj\n", "2:1: ", "a name"},
    {"UnknownTopKey", "version: 1\nmodles: [a.obj]\n", "2:1: ", "did you mean 'models'"},
    {"DuplicateTopKey", "version: 1\nmodels: [a.obj]\nmodels: [b.ply]\n",
     "3:1: ", "stands in line 2 already"},
    // The version.
    {"NewerVersion", "version: 2\nmodels: [a.obj]\n", "1:10: ", "version 2 is not known"},
    {"VersionAsFraction", "version: 1.0\nmodels: [a.obj]\n", "1:10: ", "version 1.0 is not known"},
    {"VersionAsList", "version: [1]\nmodels: [a.obj]\n", "1:10: ", "a single value"},
    {"VersionMissing", "models: [a.obj]\n", "1:1: ", "'version: 1' is missing"},
    {"LineBreakInStore", "version: 1\nstore: \"a\\nb\"\nmodels: [a.obj]\n",
     "2:8: ", "control characters"},
    {"StoreIsAList", "version: 1\nstore: [x]\nmodels: [a.obj]\n", "2:8: ", "a single value"},
    // Models.
    {"NoModels", "version: 1\n", "1:1: ", "'models' is missing"},
    {"EmptyModels", "version: 1\nmodels: []\n", "2:9: ", "there is no model"},
    {"ModelsNull", "version: 1\nmodels:\n", "2:1: ", "there is no model"},
    {"ModelsIsText", "version: 1\nmodels: a.obj\n", "2:9: ", "'key: value'"},
    {"MissingFile", "version: 1\nmodels:\n  - a.obj\n  - c.obj\n", "4:5: ", "there is no file"},
    {"LongNameOfFile", "version: 1\nmodels:\n  - " + std::string(300, 'x') + "\n",
     "3:5: ", "there is no file"},
    {"FolderAsFile", "version: 1\nmodels: [.]\n", "2:10: ", "there is no file"},
    {"PatternWithoutMatch", "version: 1\nmodels: ['*.stl']\n", "2:10: ", "no file matches"},
    {"PatternWithAName", "version: 1\nmodels: {x: '*.obj'}\n", "2:13: ", "no single name"},
    {"NoVariantOfAModel", "version: 1\nmodels: {x: {file: a.obj, variants: []}}\n",
     "2:37: ", "there is no variant"},
    {"SameModelTwice", "version: 1\nmodels: [a.obj, a.obj]\n", "2:17: ", "two models 'a'; name"},
    {"DuplicateModel", "version: 1\nmodels:\n  x: a.obj\n  x: b.ply\n", "4:3: ", "line 3 already"},
    {"SlashInName", "version: 1\nmodels: {x/y: a.obj}\n", "2:15: ", "cannot be a name"},
    {"DotsAsName", "version: 1\nmodels: {..: a.obj}\n", "2:14: ", "cannot be a name"},
    {"SpaceInName", "version: 1\nmodels: {my part: a.obj}\n", "2:19: ", "cannot be a name"},
    {"ModelIsAList", "version: 1\nmodels: {x: [a.obj]}\n", "2:13: ", "'key: value'"},
    {"UnknownModelKey", "version: 1\nmodels: {x: {fiel: a.obj}}\n", "2:14: ", "mean 'file'"},
    {"FileAndSample", "version: 1\nmodels: {x: {file: a.obj, sample: {}}}\n", "2:10: ", "either"},
    {"NeitherFileNorSample", "version: 1\nmodels: {x: {}}\n", "2:10: ", "either"},
    {"StageOfTheNameOfSamples",
     "version: 1\nmodels: {x: {sample: {}}}\nstages: {sample: {output: extra}, import: {}}\n",
     "3:10: ", "'program: sample'"},
    {"UnknownSampleKind", "version: 1\nmodels: {x: {sample: {kind: teapot}}}\n",
     "2:23: ", "teapot"},
    {"UnknownSampleOption", "version: 1\nmodels: {x: {sample: {facse: 900}}}\n",
     "2:23: ", "mean 'faces'"},
    {"UnknownVariantOfModel",
     "version: 1\nmodels: {x: {file: a.obj, variants: [fin]}}\nvariants: {fine: {}}\n",
     "2:38: ", "did you mean 'fine'"},
    // Files beside a model.
    {"UnknownInput", "version: 1\nmodels: {x: {file: a.obj, inputs: {guide: g.obj}}}\n",
     "2:36: ", "did you mean 'guides'"},
    {"MissingInput", "version: 1\nmodels: {x: {file: a.obj, inputs: {guides: none.obj}}}\n",
     "2:44: ", "there is no file"},
    {"LongNameOfInput",
     "version: 1\nmodels: {x: {file: a.obj, inputs: {guides: " + std::string(300, 'x') + "}}}\n",
     "2:44: ", "there is no file"},
    {"InputsIsText", "version: 1\nmodels: {x: {file: a.obj, inputs: a.obj}}\n",
     "2:35: ", "'key: value'"},
    {"InputIsAnArtifact", "version: 1\nmodels: {x: {file: a.obj, inputs: {mesh: a.obj}}}\n",
     "2:36: ", "unknown key 'mesh'"},
    {"InputNobodyHas",
     "version: 1\nmodels: {x: {file: a.obj, inputs: {guides: a.obj}}}\nstages:\n  import: {}\n"
     "  tensor: {}\n  smooth: {inputs: {guides: flow}}\n  other: {program: smooth, output: f}\n",
     "6:3: ", "no model has it"},
    {"UnknownSizes",
     "version: 1\nmodels: [a.obj]\nstages:\n  import: {}\n  tensor: {}\n  smooth: {}\n"
     "  trace: {inputs: {size: sizes}}\n",
     "7:3: ", "no stage makes it"},
    // Options.
    {"OptionsIsAList", "version: 1\nmodels: [a.obj]\noptions: [trace]\n", "3:10: ", "'key: value'"},
    {"UnknownStage", "version: 1\nmodels: [a.obj]\noptions: {trase: {seed: 1}}\n",
     "3:11: ", "did you mean 'trace'"},
    {"UnknownOption", "version: 1\nmodels: [a.obj]\noptions:\n  trace:\n    sead: 1\n",
     "5:5: ", "did you mean 'seed'"},
    {"OptionOutOfRange", "version: 1\nmodels: [a.obj]\noptions: {tensor: {radius: 99%}}\n",
     "3:20: ", "between 0.01% and 50%"},
    {"OptionIsAList", "version: 1\nmodels: [a.obj]\noptions: {trace: {seed: [1, 2]}}\n",
     "3:25: ", "a single value"},
    {"NoIsNotFalse", "version: 1\nmodels: [a.obj]\noptions: {import: {strict: no}}\n",
     "3:20: ", "true or false"},
    {"DateIsNoNumber", "version: 1\nmodels: [a.obj]\noptions: {trace: {seed: 2001-01-01}}\n",
     "3:19: ", "a whole number"},
    {"HexIsNoNumber", "version: 1\nmodels: [a.obj]\noptions: {trace: {seed: 0x10}}\n",
     "3:19: ", "a whole number"},
    {"DuplicateOption", "version: 1\nmodels: [a.obj]\noptions: {trace: {seed: 1, seed: 2}}\n",
     "3:28: ", "line 3 already"},
    // Variants.
    {"DuplicateVariant", "version: 1\nmodels: [a.obj]\nvariants:\n  x: {}\n  x: {}\n",
     "5:3: ", "line 4 already"},
    {"VariantsOfOneName",
     "version: 1\nmodels: [a.obj]\nvariants:\n  x-1: {}\n  x: {trace: {seed: [1]}}\n",
     "5:3: ", "two variants 'x-1'"},
    {"ValueTwice", "version: 1\nmodels: [a.obj]\nvariants: {x: {trace: {seed: [1, 1]}}}\n",
     "3:12: ", "two variants 'x-1'"},
    {"VariantOutOfRange",
     "version: 1\nmodels: [a.obj]\nvariants: {x: {trace: {stop-fraction: [0.5, 7]}}}\n",
     "3:45: ", "stop-fraction"},
    {"SlashInVariant", "version: 1\nmodels: [a.obj]\nvariants: {x/y: {}}\n",
     "3:12: ", "cannot be a name"},
    {"NoValues", "version: 1\nmodels: [a.obj]\nvariants: {x: {trace: {seed: []}}}\n",
     "3:30: ", "empty"},
    {"TwoGoals", "version: 1\nmodels: [a.obj]\noptions: {trace: {tolerance: 1%, vertices: 400}}\n",
     "3:34: ", "'tolerance' and 'vertices' exclude each other"},
    {"TwoGoalsOfAVariant",
     "version: 1\nmodels: [a.obj]\nvariants: {x: {trace: {vertices: 400, faces: [400]}}}\n",
     "3:47: ", "exclude each other"},
    {"TwoGoalsOfAStage",
     "version: 1\nmodels: [a.obj]\nstages: {import: {}, tensor: {}, smooth: {}, "
     "trace: {options: {faces: 9, vertices: 9}}}\n",
     "3:74: ", "exclude each other"},
    {"MergeKey",
     "version: 1\nmodels: [a.obj]\noptions:\n  trace: &t {seed: 1}\nvariants:\n  x:\n    trace:\n"
     "      <<: *t\n",
     "8:7: ", "merge keys"},
    {"StoreIsTheFolder", "version: 1\nstore: ''\nmodels: [a.obj]\n",
     "2:8: ", "cannot be the store"},
    {"StoreIsTheFolderByAnotherName", "version: 1\nstore: x/../\nmodels: [a.obj]\n",
     "2:8: ", "cannot be the store"},
    // Stages.
    {"NoStage", "version: 1\nmodels: [a.obj]\nstages: {}\n", "3:9: ", "there is no stage"},
    {"StagesIsAList", "version: 1\nmodels: [a.obj]\nstages: [import]\n", "3:9: ", "'key: value'"},
    {"UnknownStageKey", "version: 1\nmodels: [a.obj]\nstages: {import: {optoins: {}}}\n",
     "3:19: ", "did you mean 'options'"},
    {"UnknownProgram", "version: 1\nmodels: [a.obj]\nstages: {import: {program: strake-imprt}}\n",
     "3:28: ", "did you mean 'import'"},
    {"NameIsNoProgram", "version: 1\nmodels: [a.obj]\nstages: {prepare: {}}\n",
     "3:10: ", "name one of them with 'program:'"},
    {"UnknownPort", "version: 1\nmodels: [a.obj]\nstages: {import: {inputs: {inpt: model}}}\n",
     "3:28: ", "did you mean 'input'"},
    {"InputNobodyMakes",
     "version: 1\nmodels: [a.obj]\nstages:\n  import: {}\n  tensor: {inputs: {mesh: msh}}\n",
     "5:3: ", "did you mean 'mesh'"},
    {"WrongKind",
     "version: 1\nmodels: [a.obj]\nstages:\n  import: {}\n  tensor: {}\n"
     "  smooth: {inputs: {mesh: tensor}}\n",
     "6:3: ", "wrong kind"},
    {"TwoMakersOfOne",
     "version: 1\nmodels: [a.obj]\nstages:\n  import: {}\n  other: {program: import}\n",
     "5:3: ", "two stages make 'mesh'"},
    {"Cycle",
     "version: 1\nmodels: [a.obj]\nstages:\n  import: {inputs: {input: quads}}\n"
     "  tensor: {}\n  smooth: {}\n  trace: {}\n  mesh: {}\n",
     "4:3: ", "cycle"},
    {"StageOptionOutOfRange",
     "version: 1\nmodels: [a.obj]\nstages: {import: {options: {feature-angle: 200}}}\n",
     "3:29: ", "between 0 and 180"},
    {"ForeignOption", "version: 1\nmodels: [a.obj]\nstages: {import: {options: {seed: 2}}}\n",
     "3:29: ", "has no option 'seed'"},
    // Resources.
    {"UnknownResource", "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {mem: 1GB}}}\n",
     "3:31: ", "unknown key 'mem'"},
    {"NoAmount", "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {memory: lots}}}\n",
     "3:39: ", "write e.g. 2GB"},
    {"AmountWithoutUnit",
     "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {memory: 4000}}}\n",
     "3:39: ", "2GB, a number and a unit"},
    {"TimeWithoutUnit", "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {time: 90}}}\n",
     "3:37: ", "10min, a number and a unit"},
    {"NoTime", "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {time: 2GB}}}\n",
     "3:37: ", "write e.g. 10min"},
    {"FractionOfAThread",
     "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {threads: 1.5}}}\n",
     "3:40: ", "whole number"},
    {"PartsBesideACoarserMesh",
     "version: 1\nmodels: [a.obj]\nstages: {import: {}, coarsen: {}, "
     "tensor: {resources: {parts: 2}}}\n",
     "3:35: ", "vertices of a coarser mesh"},
    {"PartsOfAnImport", "version: 1\nmodels: [a.obj]\nstages: {import: {resources: {parts: 2}}}\n",
     "3:38: ", "cannot work in parts"},
    // Outputs.
    {"UnknownArtifact", "version: 1\nmodels: [a.obj]\noutputs: {quad: x.obj}\n",
     "3:11: ", "did you mean 'quads'"},
    {"WrongExtension", "version: 1\nmodels: [a.obj]\noutputs: {quads: x.stl}\n",
     "3:18: ", "must end in one of .hdf, .obj"},
    {"ReportAsText", "version: 1\nmodels: [a.obj]\noutputs: {report: x.txt}\n", "3:19: ", ".json"},
    {"OneFileForAllModels", "version: 1\nmodels: [a.obj, b.ply]\noutputs: {quads: x.obj}\n",
     "3:18: ", "put {model} in it"},
    {"OneFileForAllVariants",
     "version: 1\nmodels: [a.obj]\nvariants: {x: {}, y: {}}\noutputs: {quads: '{model}.obj'}\n",
     "4:18: ", "put {variant} in it"},
    {"UnknownMark", "version: 1\nmodels: [a.obj]\noutputs: {quads: '{modle}.obj'}\n",
     "3:18: ", "only {model} and {variant}"},
    {"OutputIsTheModel", "version: 1\nmodels: [b.ply]\noutputs: {quads: '{model}.ply'}\n",
     "3:18: ", "is the model 'b'"},
    {"OutputInTheStore", "version: 1\nstore: s/\nmodels: [a.obj]\noutputs: {mesh: s/../s/a.hdf}\n",
     "4:17: ", "lies in the store"},
    {"OneFileForTwoArtifacts",
     "version: 1\nmodels: [a.obj]\noutputs:\n  mesh: out/x.hdf\n  lines: out/x.hdf\n",
     "5:10: ", "would be written twice"},
    {"NamesThatRunTogether",
     "version: 1\nmodels: {x-y: a.obj, x: b.ply}\nvariants: {z: {}, y-z: {}}\n"
     "outputs: {quads: '{model}-{variant}.obj'}\n",
     "4:18: ", "would be written twice"},
};

class BadPipeline : public PipelineFileTest, public testing::WithParamInterface<Fault> {};
INSTANTIATE_TEST_SUITE_P(Description, BadPipeline, testing::ValuesIn(kFaults),
                         [](const auto& fault) { return std::string(fault.param.name); });

TEST_P(BadPipeline, IsRefusedWithPlaceAndRemedy) {
  const std::string said = complaint(GetParam().text);
  EXPECT_EQ(said.rfind(GetParam().place, 0), 0u) << said;
  EXPECT_NE(said.find(GetParam().part), std::string::npos) << said;
}

class GoodPipeline : public PipelineFileTest {};

TEST_F(GoodPipeline, MissingFilesAreBadInput) {
  EXPECT_THROW(read_description(folder_ / "nowhere.yaml"), InputError);
  EXPECT_THROW(read_description(folder_), InputError);
}

TEST_F(GoodPipeline, StandsForTheStandardChain) {
  const Description description = describe("version: 1\nmodels: [a.obj]\n");
  std::string names;
  for (const Rule& rule : description.rules) names += rule.name + " ";
  EXPECT_EQ(names.rfind("import tensor smooth trace mesh ", 0), 0u) << names;
  EXPECT_EQ(description.rules.back().name, "evaluate");
  ASSERT_EQ(description.models.size(), 1u);
  EXPECT_EQ(description.models[0].name, "a");
  EXPECT_EQ(description.models[0].file, folder_ / "a.obj");
  EXPECT_EQ(description.store, folder_ / ".strake");
  EXPECT_EQ(description.variants.size(), 1u);
}

TEST_F(GoodPipeline, StagesComeInAnOrderThatWorks) {
  const Description description = describe(
      "version: 1\nmodels: [a.obj]\nstages:\n  mesh: {}\n  trace: {}\n  smooth: {}\n"
      "  tensor: {}\n  import: {}\n");
  std::string names;
  for (const Rule& rule : description.rules) names += rule.name + " ";
  EXPECT_EQ(names, "import tensor smooth trace mesh ");
}

TEST_F(GoodPipeline, ScalarsAreWhatIsWritten) {
  const Description description = describe(
      "version: 1\nmodels: {no: a.obj, 2001-01-01: b.ply}\n"
      "options: {trace: {seed: 012, vertices: ''}, tensor: {radius: 1e-1%}}\n");
  EXPECT_EQ(description.models[0].name, "no");
  EXPECT_EQ(description.models[1].name, "2001-01-01");
  ASSERT_EQ(description.settings.size(), 3u);
  EXPECT_EQ(description.settings[0].value, "12");
  EXPECT_EQ(description.settings[1].value, "");
  EXPECT_EQ(description.settings[2].value, "0.1%");
}

TEST_F(GoodPipeline, ListsStandForAllCombinations) {
  const Description description = describe(
      "version: 1\nmodels: [a.obj]\n"
      "variants: {v: {trace: {seed: [1, 2], tolerance: [0.1%, 0.5]}}, w: {}}\n");
  std::string names;
  for (const Variant& variant : description.variants) names += variant.name + " ";
  EXPECT_EQ(names, "v-1-0.1 v-1-0.5 v-2-0.1 v-2-0.5 w ");
}

TEST_F(GoodPipeline, PatternsMatchFilesOnly) {
  fs::create_directory(folder_ / "folder.obj");
  put("c[1].obj", "v 0 0 0\n");
  put("d.obj", "v 0 0 0\n");
  const Description description = describe("version: 1\nmodels: {c: 'c[1].obj'}\n");
  EXPECT_EQ(description.models.at(0).file, folder_ / "c[1].obj") << "a file of that very name";
  std::string names;
  for (const ModelEntry& model : describe("version: 1\nmodels: ['[adf]*.obj']\n").models) {
    names += model.name + " ";
  }
  EXPECT_EQ(names, "a d ");
}

TEST_F(GoodPipeline, AFileWhoseStemIsNoNameIsToBeNamed) {
  put("Müller 1.obj", "v 0 0 0\n");
  const std::string said = complaint("version: 1\nmodels: ['M*.obj']\n");
  EXPECT_NE(said.find("'models: { NAME: \"Müller 1.obj\" }'"), std::string::npos) << said;
  const Description named = describe("version: 1\nmodels: {mueller: 'Müller 1.obj'}\n");
  EXPECT_EQ(named.models[0].file, folder_ / "Müller 1.obj");
  EXPECT_EQ(complaint("version: 1\nmodels: {my part: a.obj}\n").find("NAME"), std::string::npos);
}

TEST_F(GoodPipeline, MarksInTheFoldersNameAreNoPattern) {
  fs::create_directory(folder_ / "old [1]*");
  put("old [1]*/a.obj", "v 0 0 0\n");
  put("old [1]*/pipeline.yaml", "version: 1\nmodels: ['?.obj']\n");
  const Description description = read_description(folder_ / "old [1]*" / "pipeline.yaml");
  ASSERT_EQ(description.models.size(), 1u);
  EXPECT_EQ(description.models[0].file, folder_ / "old [1]*" / "a.obj");
}

/// The system follows a link before it goes a folder up.
TEST_F(GoodPipeline, DotsAreTakenAsTheSystemTakesThem) {
  fs::create_directories(folder_ / "real" / "sub");
  fs::create_directory_symlink("real/sub", folder_ / "link");
  put("real/a.obj", "v 1 2 3\n");
  const Description description =
      describe("version: 1\nmodels: {x: link/../a.obj, y: real/../a.obj}\n");
  EXPECT_TRUE(fs::equivalent(description.models[0].file, folder_ / "real" / "a.obj"));
  EXPECT_EQ(description.models[1].file, folder_ / "a.obj");
  EXPECT_EQ(without_dots("/nowhere/at/../all/./x"), "/nowhere/all/x");
}

/// Ninja and Slurm take line breaks for the end of what they are told; JSON has only UTF-8.
TEST_F(GoodPipeline, FoldersWhoseNamesCannotBeWrittenAreRefused) {
  for (const std::string name : {"two\nlines", "a\ttab", "a\x7f", "not UTF-8 \xff"}) {
    fs::create_directory(folder_ / name);
    put(name + "/pipeline.yaml", "version: 1\nmodels: ['../a.obj']\n");
    try {
      read_description(folder_ / name / "pipeline.yaml");
      ADD_FAILURE() << name;
    } catch (const UsageError& error) {
      const std::string said = error.what();
      EXPECT_NE(said.find(" characters "), std::string::npos) << said;
      EXPECT_NE(said.find("rename it"), std::string::npos) << said;
      EXPECT_EQ(said.find('\n'), std::string::npos) << said;
    }
  }
}

TEST_F(GoodPipeline, FilesWhoseNamesCannotBeWrittenAreRefused) {
  const std::string name = "no \xff UTF-8";
  fs::create_directory(folder_ / name);
  put(name + "/m.obj", "v 0 0 0\n");
  const std::vector<std::string> texts = {
      "models: ['*/m.obj']\n", "models: {m: '" + name + "/m.obj'}\n",
      "models: {a: {file: a.obj, inputs: {guides: '" + name + "/m.obj'}}}\n",
      "models: [a.obj]\noutputs: {quads: '" + name + "/{model}.obj'}\n",
      "models: [a.obj]\noutputs: {quads: \"two\\nlines.obj\"}\n"};
  for (const std::string& text : texts) {
    const std::string said = complaint("version: 1\n" + text);
    EXPECT_NE(said.find("in it; rename it"), std::string::npos) << said;
  }
}

TEST_F(GoodPipeline, TheSpellingOfTheCommandLineIsAnsweredByThatOfFiles) {
  for (const char* text :
       {"version: 1\nmodels: [a.obj]\nvariants: { fine: { trace.vertices: 3000 } }\n",
        "version: 1\nmodels: [a.obj]\noptions: { trace.vertices: 3000 }\n"}) {
    const std::string said = complaint(text);
    EXPECT_NE(said.find("'trace: { vertices: 3000 }'"), std::string::npos) << said;
  }
}

TEST_F(GoodPipeline, SettingsFromTheCommandLine) {
  const Description description = describe("version: 1\nmodels: [a.obj]\n");
  const Setting setting = parse_setting(description, "trace.seed=7");
  EXPECT_EQ(setting.rule + " " + setting.option + " " + setting.value, "trace seed 7");
  for (const char* bad : {"trace.seed", "seed=7", "trace.sed=7", "trac.seed=7", "trace.seed=x",
                          "trace.seed=", "=", ".=", "trace.tolerance=-1"}) {
    EXPECT_THROW(parse_setting(description, bad), UsageError) << bad;
  }
}

}  // namespace
}  // namespace strake::run_test
