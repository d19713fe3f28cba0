#include "common/stage/command_tree.h"

#include <CLI/App.hpp>
#include <algorithm>
#include <set>

namespace strake {
namespace {

CommandWord word_of(const CLI::Option& option) {
  CommandWord word;
  if (option.nonpositional()) {
    for (const std::string& name : option.get_snames()) word.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) word.names.push_back("--" + name);
  } else {
    word.names.push_back(option.get_name(true));
  }
  if (option.get_items_expected_max() > 0) word.type = option.get_type_name();
  word.default_text = option.get_default_str();
  word.help = option.get_description();
  word.required = option.get_required();
  return word;
}

/// Adds what is declared at this level and in its option groups, which are commands without name.
void collect(const CLI::App& app, const std::string& heading, CommandTree& tree,
             std::set<const CLI::Option*>& seen) {
  std::vector<const CLI::App*> groups;
  for (const CLI::App* part : app.get_subcommands({})) {
    if (part->get_name().empty()) groups.push_back(part);
  }
  // An application lists the options of its groups too, which belong under their own headings.
  std::set<const CLI::Option*> of_groups;
  for (const CLI::App* group : groups) {
    for (const CLI::Option* option : group->get_options()) of_groups.insert(option);
  }
  const bool is_group = app.get_name().empty();
  CommandGroup own{heading, is_group ? app.get_description() : "", {}};
  for (const CLI::Option* option : app.get_options()) {
    if (of_groups.count(option) != 0 || !seen.insert(option).second) continue;
    if (is_group && option == app.get_help_ptr()) continue;  // each has one of its own, unused
    if (option->nonpositional()) {
      own.options.push_back(word_of(*option));
    } else {
      tree.positionals.push_back(word_of(*option));
    }
  }
  if (!own.options.empty()) tree.groups.push_back(std::move(own));
  for (const CLI::App* group : groups) collect(*group, group->get_group(), tree, seen);
}

}  // namespace

std::vector<std::string> CommandWord::choices() const {
  std::vector<std::string> words;
  if (type.find('|') == std::string::npos) return words;
  for (std::size_t begin = 0; begin <= type.size();) {
    const std::size_t end = std::min(type.find('|', begin), type.size());
    words.push_back(type.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

std::vector<CommandWord> CommandTree::options() const {
  std::vector<CommandWord> all;
  for (const CommandGroup& group : groups) {
    all.insert(all.end(), group.options.begin(), group.options.end());
  }
  return all;
}

CommandTree command_tree(const CLI::App& app) {
  CommandTree tree;
  tree.name = app.get_name();
  tree.summary = app.get_description();
  tree.examples = app.get_footer();
  std::set<const CLI::Option*> seen;
  collect(app, "Options", tree, seen);
  for (const CLI::App* command : app.get_subcommands({})) {
    constexpr const char* kHidden = "";
    if (command->get_name().empty() || command->get_group() == kHidden) continue;
    tree.commands.push_back(command_tree(*command));
  }
  return tree;
}

}  // namespace strake
