#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "common/stage/command_tree.h"

namespace strake {
namespace {

/// Text as man(7) takes it: no control lines, dashes that stay dashes.
std::string roff(const std::string& text) {
  std::string escaped;
  bool line_begins = true;
  for (const char c : text) {
    if (line_begins && (c == '.' || c == '\'')) escaped += "\\&";
    if (c == '\\') {
      escaped += "\\e";
    } else if (c == '-') {
      escaped += "\\-";
    } else {
      escaped += c;
    }
    line_begins = c == '\n';
  }
  return escaped;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
  });
  return text;
}

/// "-o, --output FILE".
std::string names_of(const CommandWord& word) {
  std::string text;
  for (const std::string& name : word.names) {
    text += fmt::format("{}\\fB{}\\fR", text.empty() ? "" : ", ", roff(name));
  }
  if (word.takes_value()) text += fmt::format(" \\fI{}\\fR", roff(word.type));
  return text;
}

void add_words(const std::vector<CommandWord>& words, std::string& page) {
  for (const CommandWord& word : words) {
    page += ".TP\n" + names_of(word) + "\n" + roff(word.help);
    if (word.takes_value() && !word.default_text.empty()) {
      page += fmt::format(" Default: {}.", roff(word.default_text));
    }
    page += "\n";
  }
}

void add_synopsis(const CommandTree& command, const std::string& line, std::string& page) {
  std::string words;
  for (const CommandWord& word : command.positionals) {
    const std::string name = fmt::format("\\fI{}\\fR", roff(word.names.front()));
    words += word.required ? " " + name : " [" + name + "]";
  }
  const bool has_options = !command.groups.empty();
  if (!command.commands.empty()) {
    page += fmt::format("\\fB{}\\fR \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n", roff(line));
    return;
  }
  page +=
      fmt::format("\\fB{}\\fR{}{}\n", roff(line), words, has_options ? " [\\fIOPTIONS\\fR]" : "");
}

void add_groups(const CommandTree& command, std::string& page) {
  add_words(command.positionals, page);
  for (const CommandGroup& group : command.groups) {
    if (command.groups.size() > 1) {
      page += fmt::format(".PP\n\\fI{}\\fR\n", roff(group.heading));
      if (!group.summary.empty()) page += ".br\n" + roff(group.summary) + "\n";
    }
    add_words(group.options, page);
  }
}

void add_examples(const CommandTree& command, std::string& page) {
  if (command.examples.empty()) return;
  page += ".PP\n.nf\n" + roff(command.examples) + "\n.fi\n";
}

constexpr const char* kExitStatus = R"(.SH EXIT STATUS
.TP
.B 0
Done.
.TP
.B 1
Internal error.
.TP
.B 2
Wrong use: unknown option, value out of range.
.TP
.B 3
A file is missing, damaged, holds nothing usable, or cannot be written.
.TP
.B 4
Inputs do not belong together.
.TP
.B 5
The result failed its own check, and was not written; of strake check: a mesh is not sound.
.TP
.B 6
The tolerance was not reached; places are named, and nothing was written.
.TP
.B 130
Interrupted.
.SH ENVIRONMENT
.TP
.B NO_COLOR
If set to anything, messages have no colours, which they have on terminals only.
)";

}  // namespace

std::string man_page(const CommandTree& program, const std::string& version) {
  std::string page =
      fmt::format(".TH {} 1 \"\" \"strake {}\" \"strake\"\n.SH NAME\n{} \\- {}\n",
                  upper(roff(program.name)), version, roff(program.name), roff(program.summary));
  page += ".SH SYNOPSIS\n";
  add_synopsis(program, program.name, page);
  page += ".SH OPTIONS\n";
  add_groups(program, page);
  if (!program.commands.empty()) page += ".SH COMMANDS\n";
  for (const CommandTree& command : program.commands) {
    page += fmt::format(".SS {}\n{}\n.PP\n", roff(command.name), roff(command.summary));
    add_synopsis(command, program.name + " " + command.name, page);
    add_groups(command, page);
    add_examples(command, page);
  }
  if (!program.examples.empty()) {
    page += ".SH EXAMPLES\n";
    add_examples(program, page);
  }
  return page + kExitStatus;
}

}  // namespace strake
