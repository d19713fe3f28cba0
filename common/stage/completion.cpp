#include <fmt/format.h>

#include <algorithm>

#include "common/core/error.h"
#include "common/core/text.h"
#include "common/stage/command_tree.h"

namespace strake {
namespace {

/// A name that shells take for a function: _strake_tensor.
std::string function_name(const std::string& program) {
  std::string name = "_" + program;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

/// The text within single quotes of bash and zsh.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? "'\\''" : std::string(1, c);
  return result + "'";
}

std::string first_sentence(const std::string& help) {
  return help.substr(0, std::min(help.find(". "), help.size()));
}

// Bash: which command the words before name, then what fits there.

/// How bash completes a value or a file.
std::string bash_values(const CommandWord& word) {
  if (const auto choices = word.choices(); !choices.empty()) {
    return fmt::format("mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$cur\")",
                       join_words(choices, " "));
  }
  if (word.takes_file() || word.takes_folder()) {
    return fmt::format(
        "compopt -o filenames 2>/dev/null; mapfile -t COMPREPLY < <(compgen {} -- \"$cur\")",
        word.takes_folder() ? "-d" : "-f");
  }
  return "COMPREPLY=()";
}

void add_bash_command(const CommandTree& command, const std::string& key, std::string& script) {
  std::string names;
  for (const CommandWord& option : command.options()) {
    names += (names.empty() ? "" : " ") + join_words(option.names, " ");
    if (!option.takes_value()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names) patterns.push_back(quoted(key + " " + name));
    script +=
        fmt::format("    {}) {}; return ;;\n", join_words(patterns, " | "), bash_values(option));
  }
  script += fmt::format(
      "    {}*)\n      if [[ $cur == -* ]]; then\n        mapfile -t COMPREPLY < "
      "<(compgen -W '{}' -- \"$cur\")\n",
      quoted(key + " "), names);
  // Of several positionals those of files are completed, whichever it is.
  const auto file = std::find_if(command.positionals.begin(), command.positionals.end(),
                                 [](const CommandWord& word) { return word.takes_file(); });
  if (!command.commands.empty()) {
    std::vector<std::string> commands;
    for (const CommandTree& each : command.commands) commands.push_back(each.name);
    script +=
        fmt::format("      else\n        mapfile -t COMPREPLY < <(compgen -W '{}' -- \"$cur\")\n",
                    join_words(commands, " "));
  } else if (file != command.positionals.end()) {
    script += "      else\n        " + bash_values(*file) + "\n";
  } else if (!command.positionals.empty()) {
    script += "      else\n        " + bash_values(command.positionals.front()) + "\n";
  }
  script += "      fi ;;\n";
}

std::string bash_script(const CommandTree& program) {
  const std::string function = function_name(program.name);
  std::string script =
      fmt::format("# Completion of {0} for bash.\n{1}() {{\n", program.name, function);
  script += "  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} command= i\n";
  if (!program.commands.empty()) {
    std::vector<std::string> commands;
    for (const CommandTree& each : program.commands) commands.push_back(each.name);
    script += fmt::format(
        "  for ((i = 1; i < COMP_CWORD; i++)); do\n    case ${{COMP_WORDS[i]}} in\n"
        "      {}) command=${{COMP_WORDS[i]}}; break ;;\n    esac\n  done\n",
        join_words(commands, " | "));
  }
  script += "  COMPREPLY=()\n  case \"$command $prev\" in\n";
  for (const CommandTree& each : program.commands) add_bash_command(each, each.name, script);
  add_bash_command(program, "", script);
  return script + fmt::format("  esac\n}}\ncomplete -F {} {}\n", function, program.name);
}

// Zsh: one _arguments a command.

std::string zsh_text(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') result += '\\';
    result += c;
  }
  return result;
}

/// ":FILE:_files", the part of a specification that says what a value is.
std::string zsh_value(const CommandWord& word) {
  std::string action;
  if (const auto choices = word.choices(); !choices.empty()) {
    return fmt::format(":value:({})", join_words(choices, " "));
  }
  if (word.takes_file()) action = "_files";
  if (word.takes_folder()) action = "_files -/";
  return fmt::format(":{}:{}", zsh_text(word.type), action);
}

std::string zsh_arguments(const CommandTree& command) {
  std::string text;
  for (const CommandWord& option : command.options()) {
    const std::string value = option.takes_value() ? zsh_value(option) : "";
    for (const std::string& name : option.names) {
      const std::string others =
          option.names.size() > 1 ? "(" + join_words(option.names, " ") + ")" : "";
      text += " \\\n    " +
              quoted(others + name + "[" + zsh_text(first_sentence(option.help)) + "]" + value);
    }
  }
  for (const CommandWord& word : command.positionals) {
    text += " \\\n    " + quoted("*" + zsh_value(word));
    break;  // the rest are files like it
  }
  return text;
}

std::string zsh_script(const CommandTree& program) {
  const std::string function = function_name(program.name);
  std::string script = fmt::format("#compdef {}\n", program.name);
  for (const CommandTree& command : program.commands) {
    script += fmt::format("{}_{}() {{\n  _arguments{}\n}}\n", function, command.name,
                          zsh_arguments(command));
  }
  script += fmt::format("{}() {{\n", function);
  if (program.commands.empty()) {
    script += "  _arguments" + zsh_arguments(program) + "\n";
  } else {
    std::string commands;
    for (const CommandTree& command : program.commands) {
      commands += " " + quoted(command.name + ":" + first_sentence(command.summary));
    }
    script += fmt::format(
        "  local line state\n  local -a subcommands=({})\n  _arguments -C{} \\\n"
        "    '1:command:->command' '*::argument:->argument'\n"
        "  case $state in\n    command) _describe command subcommands ;;\n"
        "    argument) (( $+functions[{}_$line[1]] )) && {}_$line[1] ;;\n  esac\n",
        commands, zsh_arguments(program), function, function);
  }
  script += "}\n";
  // Both ways of use: as a file in fpath, and sourced.
  return script + fmt::format(
                      "if [ \"$funcstack[1]\" = {0} ]; then {0} \"$@\"; else compdef {0} {1}; "
                      "fi\n",
                      function, program.name);
}

// Fish: one line an option.

std::string fish_quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'' || c == '\\') result += '\\';
    result += c;
  }
  return result + "'";
}

std::string fish_value(const CommandWord& word) {
  if (const auto choices = word.choices(); !choices.empty()) {
    return " -x -a " + fish_quoted(join_words(choices, " "));
  }
  if (word.takes_folder()) return " -x -a '(__fish_complete_directories)'";
  if (word.takes_file()) return " -r -F";
  return word.takes_value() ? " -x" : "";
}

void add_fish_command(const CommandTree& command, const std::string& start, std::string& script) {
  for (const CommandWord& option : command.options()) {
    script += start;
    for (const std::string& name : option.names) {
      script += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
    }
    script += fish_value(option) + " -d " + fish_quoted(first_sentence(option.help)) + "\n";
  }
  for (const CommandWord& word : command.positionals) {
    if (!word.choices().empty()) script += start + fish_value(word) + "\n";
  }
}

std::string fish_script(const CommandTree& program) {
  std::string script = fmt::format("# Completion of {0} for fish.\n", program.name);
  const std::string start = "complete -c " + program.name;
  if (!program.commands.empty()) script += start + " -n __fish_use_subcommand -f\n";
  add_fish_command(program, start + (program.commands.empty() ? "" : " -n __fish_use_subcommand"),
                   script);
  for (const CommandTree& command : program.commands) {
    script += fmt::format("{} -n __fish_use_subcommand -a {} -d {}\n", start, command.name,
                          fish_quoted(first_sentence(command.summary)));
    add_fish_command(
        command, start + fmt::format(" -n '__fish_seen_subcommand_from {}'", command.name), script);
  }
  return script;
}

}  // namespace

std::string completion_script(const CommandTree& program, const std::string& shell) {
  if (shell == "bash") return bash_script(program);
  if (shell == "zsh") return zsh_script(program);
  if (shell == "fish") return fish_script(program);
  throw UsageError("there is no completion for the shell '" + shell +
                   "'; bash, zsh and fish have it");
}

}  // namespace strake
