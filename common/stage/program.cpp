#include "common/stage/program.h"

#include <fmt/format.h>
#include <tbb/global_control.h>
#include <tbb/info.h>

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <exception>
#include <filesystem>
#include <map>
#include <new>

#include "common/artifact/artifact.h"
#include "common/artifact/text_file.h"
#include "common/core/error.h"
#include "common/core/suggest.h"
#include "common/core/text.h"
#include "common/stage/build_facts.h"
#include "common/stage/command_tree.h"
#include "common/stage/repro.h"

namespace strake {
namespace {

namespace fs = std::filesystem;

constexpr const char* kLogJson = "--log-json";
constexpr const char* kOutOfMemory =
    "out of memory; ask for fewer or larger cells, or use a smaller mesh or a machine with more "
    "memory";

bool is_flag(const Option& option) { return std::holds_alternative<bool*>(option.target); }

/// What kind of text an option takes, for the help.
std::string type_text(const Option& option) {
  if (!option.choices.empty()) return join_words(option.choices, "|");
  if (!option.unit.empty()) return option.unit == "length" ? "LENGTH" : option.unit;
  if (std::holds_alternative<std::int64_t*>(option.target) ||
      std::holds_alternative<std::optional<std::int64_t>*>(option.target)) {
    return "N";
  }
  return std::holds_alternative<std::string*>(option.target) ? "TEXT" : "X";
}

std::string help_text(const Option& option) {
  const auto limit = [&](double value) { return limit_text(option, value); };
  std::string text = option.help;
  if (std::isfinite(option.min) && std::isfinite(option.max)) {
    text += fmt::format(" From {} to {}.", limit(option.min), limit(option.max));
  } else if (std::isfinite(option.min)) {
    text += fmt::format(" At least {}.", limit(option.min));
  }
  return text;
}

/// The files a stage program works on.
struct Paths {
  std::map<std::string, std::vector<std::string>> inputs;  ///< by port
  std::string output;
};

void add_ports(CLI::App& app, const Stage& stage, Paths& paths) {
  for (const Port& port : stage.inputs) {
    const std::string name = port.required ? port.name : "--" + port.name;
    CLI::Option* option = app.add_option(name, paths.inputs[port.name], port.help);
    option->type_name("FILE")->required(port.required);
    if (!port.many) option->expected(1)->allow_extra_args(false);
  }
  app.add_option("-o,--output", paths.output, stage.output.help)
      ->type_name("FILE")
      ->required(stage.output.kind != PortKind::report);
}

void check_paths(const Stage& stage, const Paths& paths, const ShellOptions& shell) {
  if (!paths.output.empty()) check_output_path(stage.output.kind, paths.output);
  std::vector<NamedFile> read;
  for (const auto& [port, files] : paths.inputs) {
    for (const std::string& path : files) read.push_back({"input '" + port + "'", path});
  }
  check_files(read, paths.output, shell.report_path);
}

Input load_input(PortKind kind, const std::string& path) {
  Input input = {std::make_shared<Value>(load_value(kind, path)), path, content_digest(path)};
  if (is_artifact(path)) input.provenance = read_artifact_info(path).provenance;
  return input;
}

/// Reads the inputs and notes their digests.
Inputs load_inputs(const Stage& stage, const Paths& paths, Provenance& provenance,
                   ConsoleObserver& console) {
  Inputs inputs;
  for (const Port& port : stage.inputs) {
    for (const std::string& path : paths.inputs.at(port.name)) {
      console.report("reading " + path, 0);
      Input input = load_input(port.kind, path);
      const std::string number = std::to_string(inputs.count(port.name) + 1);
      provenance.inputs.push_back({port.many ? port.name + "-" + number : port.name, input.digest});
      inputs.add(port.name, std::move(input));
    }
  }
  return inputs;
}

void make_output(const Stage& stage, const Paths& paths, const ShellOptions& shell,
                 StageRecord& record) {
  ConsoleObserver console = shell.console();
  console.begin(stage.name);
  Inputs inputs = load_inputs(stage, paths, record.provenance, console);
  StageResult result = run_stage(stage, inputs, console);
  record.report = std::move(result.report);
  for (const std::string& warning : record.report.warnings()) console.say("warning: " + warning);
  // Written first, and there last: where one of the two cannot be written there is neither.
  std::optional<AtomicFile> report;
  if (!shell.report_path.empty()) {
    write_text(report.emplace(shell.report_path), record_json(record));
  }
  if (result.output) {
    console.report("writing " + paths.output, 1);
    save_value(paths.output, *result.output, inputs.mesh_of(*result.output),
               result.provenance.value_or(record.provenance));
  } else if (!paths.output.empty()) {
    write_text(paths.output, record_json(record));
  }
  if (report) report->commit();
  // After the files: where one cannot be written, the error is all that is said.
  if (!result.output && !shell.quiet) std::fputs(report_text(record.report).c_str(), stdout);
  if (shell.verbose && result.output) console.say(report_text(record.report));
}

void run_program(const Stage& stage, const Paths& paths, const ShellOptions& shell) {
  check_paths(stage, paths, shell);
  StageRecord record{provenance_of(stage), {}};
  Repro repro{shell.repro,
              "strake-" + stage.name,
              {},
              [&] { return record.provenance; },
              shell.log_format()};
  for (const Port& port : stage.inputs) {
    const std::vector<std::string>& files = paths.inputs.at(port.name);
    repro.inputs.insert(repro.inputs.end(), files.begin(), files.end());
  }
  with_repro(repro, [&] { make_output(stage, paths, shell, record); });
}

/// The command of the command line, or the program itself where it names none.
const CLI::App& chosen_command(const CLI::App& app) {
  const std::vector<CLI::App*> commands = app.get_subcommands();
  return commands.empty() ? app : *commands.front();
}

/// Programs in the folder of this one whose names begin with its name and "-", without that.
std::vector<std::string> programs_beside(const std::string& name) {
  std::vector<std::string> found;
  std::error_code ignored;
  const fs::path self = fs::read_symlink("/proc/self/exe", ignored);
  for (const auto& entry : fs::directory_iterator(self.parent_path(), ignored)) {
    const std::string program = entry.path().filename();
    if (program.starts_with(name + "-")) found.push_back(program.substr(name.size() + 1));
  }
  return found;
}

/// What is near to a command that is none, as "; did you mean ...?"; or "".
std::string command_meant(const CLI::App& app, const std::string& word,
                          const std::vector<std::string>& known) {
  if (const std::string near = nearest_word(word, known); !near.empty()) {
    return fmt::format("; did you mean '{}'?", near);
  }
  const std::string near = nearest_word(word, programs_beside(app.get_name()));
  if (near.empty()) return "";
  return fmt::format("; did you mean the program '{}-{}'?", app.get_name(), near);
}

/// \throw UsageError where a file or folder is named "", as by a variable of a shell that is not set
void require_names(const CLI::App& command) {
  for (const CLI::Option* option : command.get_options()) {
    const std::string type = option->get_type_name();
    const std::vector<std::string>& given = option->results();
    if (!type.starts_with("FILE") && !type.starts_with("FOLDER")) continue;
    if (std::ranges::find(given, "") == given.end()) continue;
    throw UsageError(fmt::format("{} names no {}; give its name, or leave {} out",
                                 option->get_name(), type.starts_with("FILE") ? "file" : "folder",
                                 option->get_name()));
  }
  for (const CLI::App* group : command.get_subcommands({})) {
    if (group->get_name().empty() || group->parsed()) require_names(*group);
  }
}

bool is_number(const std::string& word) {
  return !word.empty() && word.find_first_not_of("0123456789.%") == std::string::npos;
}

/// What is wrong with a number behind a flag of one letter, taken for an option that begins with
/// it; or "".
std::string value_of_flag(const CLI::App& command, const std::vector<CommandWord>& options,
                          const std::string& word) {
  if (!is_number(word)) return "";
  for (const CommandWord& flag : options) {
    if (flag.takes_value() || flag.names.size() < 2 || flag.names[0].size() != 2) continue;
    const CLI::Option* given = command.get_option_no_throw(flag.names[0]);
    if (given == nullptr || given->count() == 0) continue;
    for (const CommandWord& option : options) {
      const std::string& name = option.names.back();
      if (!option.takes_value() || !name.starts_with("-" + flag.names[0])) continue;
      return fmt::format("'{}' is '{}' and takes no value; did you mean '{} {}'?", flag.names[0],
                         flag.names.back(), name, word);
    }
  }
  return "";
}

/// What is wrong with the first word that looks like an option, or should be a command, and is
/// none, or is the value of a flag; or "".
std::string unknown_word(const CLI::App& app) {
  const CLI::App& command = chosen_command(app);
  std::vector<std::string> known;
  const std::vector<CommandWord> options = command_tree(command).options();
  for (const CommandWord& option : options) {
    known.insert(known.end(), option.names.begin(), option.names.end());
  }
  if (&command == &app) {
    for (const CommandTree& each : command_tree(app).commands) known.push_back(each.name);
  }
  constexpr bool kOfCommandsToo = true;
  const bool lacks_command = &command == &app && !command_tree(app).commands.empty();
  for (const std::string& word : app.remaining(kOfCommandsToo)) {
    if (word == "%") return "there is a '%' by itself: write shares without a blank, as in 0.1%";
    if (word.front() != '-' && !lacks_command) {
      const std::string meant = value_of_flag(command, options, word);
      if (!meant.empty()) return meant;
      continue;
    }
    const std::string name = word.substr(0, word.find('='));
    if (word.front() != '-') {
      return fmt::format("there is no command '{}'{}", name, command_meant(app, name, known));
    }
    const std::string nearest = nearest_word(name, known);
    return fmt::format("there is no option '{}'{}", name,
                       nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest));
  }
  return "";
}

/// How the stage is called on files with the names of its ports.
std::string example(const Stage& stage) {
  const auto file = [](const Port& port) {
    if (port.kind == PortKind::polygons) return port.name + ".ply";
    return port.name + (port.kind == PortKind::report ? ".json" : ".hdf");
  };
  std::string line = "Example:\n  strake-" + stage.name;
  for (const Port& port : stage.inputs) {
    if (port.required) line += " " + file(port);
  }
  return line + " -o " + file(stage.output);
}

/// Whether threads could not be made, as oneTBB says it: mostly for want of memory for their
/// stacks.
bool lacks_threads(const std::exception& error) {
  return std::string_view(error.what()).find(std::strerror(EAGAIN)) != std::string_view::npos;
}

std::string unwritable(int error) {
  return std::string("the standard output cannot be written") +
         (error == 0 ? "" : std::string(": ") + std::strerror(error)) +
         "; make room, or send it elsewhere";
}

/// \throw InputError where what was printed cannot be written
void flush_output() {
  errno = 0;
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw InputError(unwritable(errno));
}

}  // namespace

void add_options(CLI::App& target, const OptionList& options) {
  for (const Option& option : options) {
    if (is_flag(option)) {
      target.add_flag_function(
          "--" + option.name,
          [option](std::int64_t count) { option.parse_into(count > 0 ? "true" : "false"); },
          help_text(option));
      continue;
    }
    target
        .add_option_function<std::string>(
            "--" + option.name, [option](const std::string& text) { option.parse_into(text); },
            help_text(option))
        ->type_name(type_text(option))
        ->default_str(option.value());
  }
}

bool is_same_file(const std::string& a, const std::string& b) {
  std::error_code ignored;
  const auto place = [&](const std::string& path) {
    return fs::weakly_canonical(fs::absolute(path, ignored), ignored);
  };
  return fs::equivalent(a, b, ignored) || place(a) == place(b);
}

void check_files(const std::vector<NamedFile>& read, const std::string& output,
                 const std::string& report) {
  std::vector<NamedFile> known = read;
  for (const auto& [role, path] : {NamedFile{"output", output}, NamedFile{"report", report}}) {
    if (path.empty()) continue;
    for (const NamedFile& other : known) {
      if (other.path.empty() || !is_same_file(path, other.path)) continue;
      throw UsageError(fmt::format("{} '{}' is the {}; give another name", role, path, other.role));
    }
    known.push_back({role, path});
  }
  if (!report.empty()) check_place("report", report);
}

void ShellOptions::add_to(CLI::App& app) {
  CLI::App* group = app.add_option_group("Running");
  add_options(*group, {{.name = "threads",
                        .target = &threads,
                        .unit = "",
                        .help = "Threads to use; 0 takes every processor. Never changes a result.",
                        .min = 0,
                        .max = 4096,
                        .affects_result = false}});
  CLI::Option* quiet_flag = group->add_flag("-q,--quiet", quiet, "Say nothing but errors.");
  group->add_flag("-v,--verbose", verbose, "Print the report too.")->excludes(quiet_flag);
  group
      ->add_flag(kLogJson, log_json,
                 "Tell progress, warnings and errors as JSON, one object a line.")
      ->excludes(quiet_flag);
  group->add_option("--report", report_path, "Write counts, measures and warnings as JSON.")
      ->type_name("FILE.json");
  group
      ->add_option("--repro", repro,
                   "After a failure that is no fault of the input: keep inputs, options and "
                   "versions in this folder, for a report.")
      ->type_name("FOLDER");
}

ConsoleObserver ShellOptions::console() const {
  const Verbosity verbosity = quiet     ? Verbosity::quiet
                              : verbose ? Verbosity::verbose
                                        : Verbosity::normal;
  return ConsoleObserver(verbosity, log_format());
}

LogFormat wanted_log_format(int argc, char** argv) {
  const bool is_json = std::any_of(
      argv, argv + argc, [](const char* word) { return std::string_view(word) == kLogJson; });
  return is_json ? LogFormat::json : LogFormat::text;
}

int run_guarded(const std::string& program, LogFormat errors, const std::function<int()>& body) {
  const auto fail = [&](const std::string& message, ExitCode code) {
    say_error(program, message, code, errors);
    return static_cast<int>(code);
  };
  try {
    open_missing_streams();
    catch_interrupts();
    const int exit_code = body();
    if (exit_code == 0) flush_output();  // a failure has its own code
    return exit_code;
  } catch (const Error& error) {
    return fail(error.what(), error.code());
  } catch (const std::bad_alloc&) {
    return fail(kOutOfMemory, ExitCode::internal);
  } catch (const std::exception& error) {
    if (std::ferror(stdout) != 0) return fail(unwritable(errno), ExitCode::bad_input);
    if (lacks_threads(error)) return fail(kOutOfMemory, ExitCode::internal);
    return fail(std::string("internal error, please report it: ") + error.what(),
                ExitCode::internal);
  }
}

std::optional<int> parse_command_line(CLI::App& app, int argc, char** argv) {
  if (argc == 3 && argv[1] == std::string_view("--generate")) {
    const CommandTree tree = command_tree(app);
    const std::string kind = argv[2];
    std::fputs(
        (kind == "man" ? man_page(tree, STRAKE_VERSION) : completion_script(tree, kind)).c_str(),
        stdout);
    return 0;
  }
  try {
    app.parse(argc, argv);
    require_names(app);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // help or version
    const std::string unknown = unknown_word(app);
    const CLI::App& command = chosen_command(app);
    throw UsageError((unknown.empty() ? error.what() : unknown) + " (see " + app.get_name() +
                     (&command == &app ? "" : " " + command.get_name()) + " --help)");
  }
}

void run_with_threads(std::int64_t threads, const std::function<void()>& work) {
  const auto limit = threads > 0 ? static_cast<std::size_t>(threads)
                                 : static_cast<std::size_t>(tbb::info::default_concurrency());
  const tbb::global_control control(tbb::global_control::max_allowed_parallelism, limit);
  work();
}

int stage_main(const Stage& stage, int argc, char** argv) {
  const std::string program = "strake-" + stage.name;
  return run_guarded(program, wanted_log_format(argc, argv), [&] {
    CLI::App app(stage.summary, program);
    app.set_version_flag("--version", version_text(program));
    app.footer(example(stage));
    Paths paths;
    ShellOptions shell;
    add_ports(app, stage, paths);
    add_options(app, stage.options);
    shell.add_to(app);
    if (const auto exit_code = parse_command_line(app, argc, argv)) return *exit_code;
    end_soon_after_interrupts(program, shell.log_format());
    run_with_threads(shell.threads, [&] { run_program(stage, paths, shell); });
    return 0;
  });
}

}  // namespace strake
