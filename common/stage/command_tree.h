#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

/// A command line as data, and what is made from it: manual pages and completion for shells.
namespace strake {

/// An option or a word of a command line.
struct CommandWord {
  std::vector<std::string> names;  ///< "-o", "--output"; of a positional its name alone
  std::string type;                ///< "FILE", "N", "cross|paper"; "" of a flag
  std::string default_text;        ///< "" where there is none
  std::string help;                ///< a sentence or a few words
  bool required = false;
  [[nodiscard]] bool takes_value() const { return !type.empty(); }
  [[nodiscard]] bool takes_file() const { return type.starts_with("FILE"); }
  [[nodiscard]] bool takes_folder() const { return type == "FOLDER"; }
  /// The words it may be where it must be one of some.
  [[nodiscard]] std::vector<std::string> choices() const;
};

/// Options under a heading.
struct CommandGroup {
  std::string heading;  ///< "Options", "Stage trace"
  std::string summary;  ///< "" where there is none
  std::vector<CommandWord> options;
};

/// A program or one of its commands.
struct CommandTree {
  std::string name;
  std::string summary;
  std::string examples;  ///< lines; "" where there are none
  std::vector<CommandWord> positionals;
  std::vector<CommandGroup> groups;
  std::vector<CommandTree> commands;

  /// The options of all groups, in order.
  [[nodiscard]] std::vector<CommandWord> options() const;
};

/// What an application declares.
CommandTree command_tree(const CLI::App& app);

/// A manual page of section 1, in the language of man(7).
std::string man_page(const CommandTree& program, const std::string& version);

/// A script that completes words of the program's command line, for bash, zsh or fish.
/// \throw UsageError for another shell
std::string completion_script(const CommandTree& program, const std::string& shell);

}  // namespace strake
