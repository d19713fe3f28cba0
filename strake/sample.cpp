#include <fmt/format.h>

#include <CLI/App.hpp>
#include <memory>
#include <string>

#include "common/artifact/meshfile/mesh_writer.h"
#include "common/core/text.h"
#include "common/core/wanted_count.h"
#include "common/geometry/samples/samples.h"
#include "strake/commands.h"

namespace strake {
namespace {

struct SampleCommand {
  std::string kind;
  std::string output;
  SampleOptions options;
};

int make(const SampleCommand& command) {
  check_output_path(PortKind::polygons, command.output);
  const PolyMesh mesh = make_sample(sample_kind(command.kind), command.options);
  write_mesh(command.output, mesh);
  const std::int64_t faces = mesh.face_count();
  if (count_miss(command.options.faces, faces) > kCountTolerance) {
    fmt::print(stderr, "warning: {} faces were wanted, but the design takes {}\n",
               command.options.faces, faces);
  }
  fmt::print("{}: {} vertices, {} faces\n", command.output, mesh.vertex_count(), mesh.face_count());
  return 0;
}

}  // namespace

void add_sample_command(CLI::App& app, Action& chosen) {
  CLI::App* command = app.add_subcommand("sample", "Make a surface to try things on.");
  command->footer(
      "Examples:\n  strake sample part -o part.ply\n  strake sample torus --faces 10000 -o "
      "torus.obj");
  const auto sample = std::make_shared<SampleCommand>();
  command->add_option("kind", sample->kind, "the surface")
      ->type_name(join_words(sample_names(), "|"))
      ->required();
  command->add_option("-o,--output", sample->output, "file to write: .obj, .ply or .off")
      ->type_name("FILE")
      ->required();
  add_options(*command, sample->options.declare());
  command->callback([sample, &chosen] { chosen = [sample] { return make(*sample); }; });
}

}  // namespace strake
