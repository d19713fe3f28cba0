#pragma once

#include <functional>

#include "common/stage/program.h"

/// The commands of the program `strake`. Each adds itself to the command line.
namespace strake {

/// Work of the command that was chosen; returns an exit code.
using Action = std::function<int()>;

void add_remesh_command(CLI::App& app, Action& chosen);
void add_info_command(CLI::App& app, Action& chosen);
void add_check_command(CLI::App& app, Action& chosen);
void add_sample_command(CLI::App& app, Action& chosen);
void add_report_command(CLI::App& app, Action& chosen);
void add_run_command(CLI::App& app, Action& chosen);
void add_submit_command(CLI::App& app, Action& chosen);
void add_status_command(CLI::App& app, Action& chosen);
void add_gc_command(CLI::App& app, Action& chosen);
void add_schema_command(CLI::App& app, Action& chosen);
void add_step_command(CLI::App& app, Action& chosen);
/// `man` and `completion`, which speak of all commands of `app`.
void add_manual_commands(CLI::App& app, Action& chosen);

}  // namespace strake
