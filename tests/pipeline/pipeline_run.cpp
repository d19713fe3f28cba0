#include "tests/pipeline/pipeline_run.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "common/artifact/digest.h"
#include "common/artifact/store/file_stamp.h"

namespace strake::pipeline_test {

namespace fs = std::filesystem;

void PipelineTest::pipeline(const std::string& text) const {
  put("pipeline.yaml",
      "version: 1\nstore: store\n"
      "stages: {import: {}, tensor: {}, smooth: {}, trace: {}, mesh: {},"
      " evaluate: {inputs: {candidate: quads}, options: {samples: 1000}}}\n" +
          text);
}

std::map<std::string, std::string> PipelineTest::run_steps(const std::string& arguments) {
  return steps_in(must("strake run " + arguments));
}

std::map<std::string, std::string> PipelineTest::steps_in(const std::string& table) {
  // "torus trace    ran      0.1 s   20 MB": columns are two spaces apart.
  std::map<std::string, std::string> steps;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t end = line.find("  ");
    if (end == std::string::npos || line.rfind("step ", 0) == 0) continue;
    const std::size_t begin = line.find_first_not_of(' ', end);
    steps[line.substr(0, end)] = line.substr(begin, line.find("  ", begin) - begin);
  }
  return steps;
}

std::string PipelineTest::names(const std::map<std::string, std::string>& steps,
                                const std::string& outcome) {
  std::string text;
  for (const auto& [step, what] : steps) {
    if (what == outcome) text += (text.empty() ? "" : ", ") + step;
  }
  return text;
}

fs::path PipelineTest::artifact(const std::string& entry, const std::string& name) const {
  fs::path found;
  for (const std::string& folder : entries()) {
    const fs::path path = file("store") / folder / name;
    if (folder.rfind(entry, 0) != 0 || !fs::exists(path)) continue;
    EXPECT_EQ(found, fs::path()) << "several entries " << entry;
    found = path;
  }
  EXPECT_NE(found, fs::path()) << "no entry " << entry << " with " << name;
  return found;
}

std::vector<std::string> PipelineTest::entries() const {
  std::vector<std::string> all;
  std::error_code ignored;
  for (const auto& model : fs::directory_iterator(file("store"), ignored)) {
    const std::string name = model.path().filename().string();
    if (name.front() == '.' || !model.is_directory()) continue;
    for (const auto& entry : fs::directory_iterator(model)) {
      all.push_back(name + "/" + entry.path().filename().string());
    }
  }
  std::sort(all.begin(), all.end());
  return all;
}

std::map<std::string, std::string> PipelineTest::snapshot(const std::string& part) const {
  std::map<std::string, std::string> all;
  for (const auto& entry : fs::recursive_directory_iterator(file(part))) {
    const std::string name = entry.path().lexically_relative(folder_).string();
    if (name == ".out" || name == ".err") continue;
    if (entry.is_directory()) {
      all[name] = "folder";
    } else if (const auto stamp = stamp_of(entry.path())) {
      all[name] = digest_file(entry.path()) + " " + std::to_string(stamp->changed_ns);
    }
  }
  return all;
}

void flip_bit(const fs::path& path) {
  std::fstream stream(path, std::ios::binary | std::ios::in | std::ios::out);
  const auto middle = static_cast<std::streamoff>(fs::file_size(path) / 2);
  stream.seekg(middle);
  const char byte = static_cast<char>(stream.get() ^ 4);
  stream.seekp(middle);
  stream.put(byte);
}

}  // namespace strake::pipeline_test
