#include <CLI/App.hpp>
#include <string>

#include "common/stage/build_facts.h"
#include "strake/commands.h"
#include "strake/report/viewer.h"

namespace {

constexpr const char* kExamples =
    R"(Examples:
  strake sample part -o part.ply
  strake remesh part.ply -o quads.obj --vertices 5000
  strake remesh part.ply -o quads.obj --tolerance 0.1% --keep work
  strake info work/field.hdf
  source <(strake completion bash)
  strake man | man -l -)";

/// Facts of the build, among them whether `strake report` works.
std::string version() {
  const bool has_page = !strake::report::viewer_page().empty();
  return strake::version_text("strake") + (has_page ? "\nwith" : "\nwithout") +
         " the page of reports";
}

}  // namespace

int main(int argc, char** argv) {
  return strake::run_guarded("strake", strake::wanted_log_format(argc, argv), [&] {
    CLI::App app("Anisotropic quad-dominant remeshing along lines of curvature.", "strake");
    app.set_version_flag("--version", version());
    app.require_subcommand(1);
    strake::Action chosen;
    strake::add_remesh_command(app, chosen);
    strake::add_info_command(app, chosen);
    strake::add_check_command(app, chosen);
    strake::add_sample_command(app, chosen);
    strake::add_report_command(app, chosen);
    strake::add_run_command(app, chosen);
    strake::add_submit_command(app, chosen);
    strake::add_status_command(app, chosen);
    strake::add_gc_command(app, chosen);
    strake::add_schema_command(app, chosen);
    strake::add_step_command(app, chosen);
    strake::add_manual_commands(app, chosen);
    app.footer(kExamples);  // after the commands, which would inherit it
    if (const auto exit_code = strake::parse_command_line(app, argc, argv)) return *exit_code;
    return chosen();
  });
}
