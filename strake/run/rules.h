#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "strake/run/description.h"

/// Parts of reading a pipeline file: its rules, and the checks of settings and names.
namespace strake {

/// The rules where a file lists none: the whole chain, each stage wired to the one before.
std::vector<Rule> standard_rules(const Place& place);

/// The rule by which the program makes a model itself.
std::vector<Rule> sample_rules();

/// The section "stages", in an order in which it can be run.
/// \param settings  takes the options that stand with the rules
/// \throw UsageError naming the line: unknown program, port, artifact or key; a cycle; ...
std::vector<Rule> read_rules(const YamlView& view, std::vector<Setting>& settings);

/// A file beside the mesh that a rule takes where a model has it.
struct SideInput {
  const Rule* rule = nullptr;
  std::string port;
  std::string name;  ///< under which models give it
};
/// All of them. \param rules  as the functions above give them; referred to by the result
std::vector<SideInput> side_inputs(const std::vector<Rule>& rules);

/// A setting whose rule and option exist and whose value is allowed.
/// \param rule_place  where the rule was named
/// \throw UsageError naming the place
Setting checked_setting(const std::vector<Rule>& rules, Setting setting, const Place& rule_place);

/// Whether the options of two settings exclude each other.
bool excludes(const Setting& one, const Setting& other);

/// Refuses settings of one place that exclude each other. \throw UsageError naming the place
void check_together(const std::vector<Setting>& settings);

/// Whether it can be part of a file name, everywhere.
bool can_be_name(std::string_view name);
/// Refuses names that could not be part of a file name.
/// \throw UsageError
/// \param remedy  what to do about it, beginning with "; "
void check_name(std::string_view name, const Place& place, std::string_view remedy = "");

/// A value as a part of a file name: "0.1%" becomes "0.1".
std::string path_part(std::string_view text);

/// Checks the name of a wanted file. \throw UsageError naming the place
void check_delivery(const Description& description, const YamlView::Entry& artifact,
                    const std::string& file, const Place& place);

}  // namespace strake
