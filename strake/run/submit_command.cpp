#include <CLI/App.hpp>
#include <memory>

#include "strake/commands.h"
#include "strake/run/run_command.h"

namespace strake {

void add_submit_command(CLI::App& app, Action& chosen) {
  CLI::App* command =
      app.add_subcommand("submit", "Like 'run --engine slurm'; or only write the job scripts.");
  command->footer("Examples:\n  strake submit\n  strake submit --script-only -o job-scripts");
  const auto run = std::make_shared<RunCommand>();
  run->engine = kSlurm;
  run->add_common_options(*command);
  run->add_slurm_options(*command);
  CLI::Option* script_only =
      command
          ->add_flag("--script-only", run->script_only,
                     "Write job scripts and submit.sh, and submit nothing. Needs no Slurm.")
          ->excludes("--wait");
  command->add_option("-o,--output", run->script_folder, "Where to, instead of the run's folder.")
      ->type_name("FOLDER")
      ->needs(script_only);
  command->callback([run, &chosen] { chosen = [run] { return run->run(); }; });
}

}  // namespace strake
