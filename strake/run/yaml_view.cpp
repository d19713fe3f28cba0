#include "strake/run/yaml_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <numeric>
#include <utility>

#include "common/core/error.h"

namespace strake {
namespace {

/// Levenshtein distance: insertions, deletions and replacements between two names.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

}  // namespace

void Place::fail(const std::string& message) const {
  throw UsageError(fmt::format("{}:{}:{}: {}", file.string(), line, column, message));
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(name, a) < edit_distance(name, b);
      });
  if (nearest != known.end() && edit_distance(name, *nearest) <= 1 + name.size() / 4) {
    return fmt::format(" (did you mean '{}'?)", *nearest);
  }
  return "";
}

YamlView YamlView::load(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw InputError(file.string() +
                     ": cannot be read; name the pipeline file with --file, or see 'strake run "
                     "--help'");
  }
  try {
    return {file, YAML::Load(stream)};
  } catch (const YAML::Exception& error) {
    Place{file, error.mark.line + 1, error.mark.column + 1}.fail("no YAML: " + error.msg);
  }
}

Place YamlView::place() const {
  const YAML::Mark mark = node_.Mark();
  return {file_, mark.line + 1, mark.column + 1};
}

std::string YamlView::text(const char* what) const {
  if (!is_scalar()) fail(fmt::format("{} is needed here, a single value", what));
  return node_.Scalar();
}

std::vector<YamlView> YamlView::items(const char* what) const {
  if (!is_list()) fail(fmt::format("{} is needed here, a list", what));
  std::vector<YamlView> views;
  for (const YAML::Node& item : node_) views.push_back({file_, item});
  return views;
}

std::vector<YamlView::Entry> YamlView::entries(const char* what) const {
  if (is_null()) return {};
  if (!is_map()) fail(fmt::format("{} is needed here, 'key: value' entries", what));
  std::vector<Entry> all;
  std::map<std::string, int> lines;
  for (const auto& pair : node_) {
    const YamlView key(file_, pair.first);
    const std::string name = key.text("a name");
    const auto [seen, is_new] = lines.emplace(name, key.place().line);
    if (!is_new) key.fail(fmt::format("'{}' stands in line {} already", name, seen->second));
    all.push_back({name, key.place(), {file_, pair.second}});
  }
  return all;
}

std::map<std::string, YamlView> YamlView::fields(const char* what,
                                                 const std::vector<std::string>& known) const {
  std::map<std::string, YamlView> found;
  for (const Entry& entry : entries(what)) {
    if (std::find(known.begin(), known.end(), entry.key) == known.end()) {
      entry.place.fail(fmt::format("unknown key '{}'{}; known: {}", entry.key,
                                   suggestion(entry.key, known), fmt::join(known, ", ")));
    }
    found.emplace(entry.key, entry.value);
  }
  return found;
}

}  // namespace strake
