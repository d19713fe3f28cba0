#include "tests/pipeline/run_program.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

namespace strake::pipeline_test {

namespace fs = std::filesystem;

ProgramTest::ProgramTest()
    : folder_(fs::temp_directory_path() / ("strake-pipeline-" + std::to_string(::getpid()))) {
  fs::create_directories(folder_);
}

ProgramTest::~ProgramTest() { fs::remove_all(folder_); }

Outcome ProgramTest::run(const std::string& command_line) {
  return shell(STRAKE_BIN "/" + command_line);
}

Outcome ProgramTest::shell(const std::string& command_line) {
  const std::string command =
      "cd '" + folder_.string() + "' && " + command_line + " >.out 2>.err </dev/null";
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, bytes(".out"), bytes(".err")};
}

std::string ProgramTest::must(const std::string& command_line) {
  const Outcome outcome = run(command_line);
  EXPECT_EQ(outcome.exit_code, 0) << command_line << "\n" << outcome.err;
  return outcome.out;
}

void ProgramTest::must_fail(int exit_code, const std::string& command_line,
                            const std::string& part) {
  const auto names = [&] {
    std::set<std::string> found;
    for (const auto& entry : fs::directory_iterator(folder_)) found.insert(entry.path().filename());
    found.insert({".out", ".err"});
    return found;
  };
  const std::set<std::string> before = names();
  const Outcome outcome = run(command_line);
  EXPECT_EQ(outcome.exit_code, exit_code) << command_line << "\n" << outcome.err;
  EXPECT_NE(outcome.err.find("error: "), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find(part), std::string::npos) << command_line << "\n" << outcome.err;
  EXPECT_EQ(names(), before) << command_line << " left files behind";
}

void ProgramTest::run_chain(const std::string& input, const std::string& prefix,
                            const std::string& flags) {
  const auto name = [&](const std::string& port) { return prefix + port + ".hdf "; };
  const std::string end = " -q " + flags;
  must("strake-import " + input + " -o " + name("mesh") + end);
  must("strake-tensor " + name("mesh") + "-o " + name("tensor") + end);
  must("strake-smooth " + name("mesh") + name("tensor") + "-o " + name("field") + end);
  must("strake-trace " + name("mesh") + name("field") + "-o " + name("lines") + end);
  must("strake-mesh " + name("mesh") + name("lines") + "-o " + name("quads") + end);
  must("strake-fit " + name("mesh") + name("quads") + "--field " + name("field") + "-o " +
       name("fitted") + end);
}

std::string ProgramTest::bytes(const std::string& name) const {
  std::ifstream stream(file(name), std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

void ProgramTest::put(const std::string& name, const std::string& text) const {
  std::ofstream(file(name), std::ios::binary) << text;
}

}  // namespace strake::pipeline_test
