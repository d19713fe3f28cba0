#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validator.hpp>

#include "strake/run/schema.h"

namespace strake {
namespace {

using nlohmann::json;

json to_json(const YAML::Node& node) {
  if (node.IsNull()) return nullptr;
  if (node.IsSequence()) {
    json list = json::array();
    for (const YAML::Node& item : node) list.push_back(to_json(item));
    return list;
  }
  if (node.IsMap()) {
    json map = json::object();
    for (const auto& pair : node) map[pair.first.Scalar()] = to_json(pair.second);
    return map;
  }
  // As editors read it: what looks like a number or a truth value is one.
  const json value = json::parse(node.Scalar(), nullptr, false);
  return value.is_number() || value.is_boolean() ? value : json(node.Scalar());
}

bool accepts(const std::string& yaml) {
  const json document = to_json(YAML::Load(yaml));
  const json schema_document = json::parse(pipeline_schema());
  valijson::Schema schema;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(schema_document),
                                          schema);
  valijson::Validator validator;
  return validator.validate(schema, valijson::adapters::NlohmannJsonAdapter(document), nullptr);
}

std::string bytes(const std::string& name) {
  std::ifstream stream(std::string(STRAKE_ROOT) + "/" + name);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

TEST(PipelineSchema, AcceptsThePipelineOfTheProject) {
  EXPECT_TRUE(accepts(bytes("pipeline.yaml")));
}

TEST(PipelineSchema, TheCopyForEditorsIsUpToDate) {
  EXPECT_EQ(bytes("docs/pipeline.schema.json"), pipeline_schema())
      << "strake schema > docs/pipeline.schema.json";
}

TEST(PipelineSchema, AcceptsEveryForm) {
  EXPECT_TRUE(accepts("{version: 1, models: [a.obj, 'scans/*.ply']}"));
  EXPECT_TRUE(accepts("{version: 1, models: {a: a.obj, b: {sample: {kind: torus, faces: 500}}}}"));
  EXPECT_TRUE(accepts("{version: 1, models: {a: {file: a.obj, inputs: {guides: lines.obj}}}}"));
  EXPECT_TRUE(accepts("{version: 1, models: [a.obj], options: {trace: {tolerance: 0.1%}}}"));
  EXPECT_TRUE(accepts("{version: 1, models: [a.obj], variants: {s: {trace: {seed: [1, 2]}}}}"));
  EXPECT_TRUE(
      accepts("{version: 1, models: [a.obj], stages: {import: , coarse: {program: trace, "
              "output: other, options: {seed: 3}}}}"));
  EXPECT_TRUE(accepts("{version: 1, models: [a.obj], outputs: {quads: ['a.obj', 'b.ply']}}"));
  EXPECT_TRUE(
      accepts("{version: 1, models: [a.obj], stages: {tensor: {resources: {parts: 4, "
              "memory: 2GB}}}}"));
  EXPECT_TRUE(accepts(
      "{version: 1, models: [a.obj], stages: {tensor: {resources: {memory-per-face: 1.5 KiB, "
      "time: 0}}}}"));
}

TEST(PipelineSchema, RefusesMistakes) {
  EXPECT_FALSE(accepts("{models: [a.obj]}")) << "no version";
  EXPECT_FALSE(accepts("{version: 2, models: [a.obj]}"));
  EXPECT_FALSE(accepts("{version: 1}")) << "no models";
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], modles: []}"));
  EXPECT_FALSE(accepts("{version: 1, models: {a: {flie: a.obj}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: {a: {file: a.obj, inputs: [lines.obj]}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], options: {trace: {sead: 1}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], options: {trace: {seed: -1}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], options: {smooth: {extension: papier}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], variants: {s: {trace: {seed: [1, x]}}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], stages: {trace: {program: strake-trase}}}"));
  EXPECT_FALSE(accepts("{version: 1, models: [a.obj], stages: {tensor: {resources: {part: 4}}}}"));
  for (const char* bad : {"memory: 4000", "memory: '4000'", "memory: 5s", "time: 90"}) {
    EXPECT_FALSE(accepts(std::string("{version: 1, models: [a.obj], stages: {tensor: {resources: "
                                     "{") +
                         bad + "}}}}"))
        << bad;
  }
}

}  // namespace
}  // namespace strake
