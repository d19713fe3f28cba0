#include "strake/run/yaml_view.h"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>

#include <algorithm>
#include <fstream>
#include <optional>

#include "common/core/error.h"
#include "common/core/suggest.h"

namespace strake {
namespace {

constexpr const char* kMergeKey = "<<";  ///< of YAML 1.1; the library takes it for a name

/// What the parser has no mark for is an empty file, or an empty document.
Place place_of(const std::filesystem::path& file, const YAML::Mark& mark) {
  return {file, std::max(mark.line, 0) + 1, std::max(mark.column, 0) + 1};
}

/// Notes where documents begin.
class DocumentStarts : public YAML::EventHandler {
 public:
  YAML::Mark last;

  void OnDocumentStart(const YAML::Mark& mark) override { last = mark; }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnAlias(const YAML::Mark& /*mark*/, YAML::anchor_t /*anchor*/) override {}
  void OnScalar(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                const std::string& /*value*/) override {}
  void OnSequenceStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/,
                       YAML::anchor_t /*anchor*/, YAML::EmitterStyle::value /*style*/) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& /*mark*/, const std::string& /*tag*/, YAML::anchor_t /*anchor*/,
                  YAML::EmitterStyle::value /*style*/) override {}
  void OnMapEnd() override {}
};

/// Where a second document begins. `YAML::LoadAll` finds documents without end where a comma stands
/// outside of everything.
std::optional<YAML::Mark> second_document(std::istream& stream) {
  DocumentStarts starts;
  YAML::Parser parser(stream);
  const bool is_there = parser.HandleNextDocument(starts) && parser.HandleNextDocument(starts);
  return is_there ? std::optional(starts.last) : std::nullopt;
}

}  // namespace

void Place::fail(const std::string& message) const {
  if (line == 0) throw UsageError(fmt::format("{}: {}", file.string(), message));
  throw UsageError(fmt::format("{}:{}:{}: {}", file.string(), line, column, message));
}

std::string suggestion(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_word(name, known);
  return nearest.empty() ? "" : fmt::format(" (did you mean '{}'?)", nearest);
}

YamlView YamlView::load(const std::filesystem::path& file) {
  std::error_code ignored;
  std::ifstream stream;  // opened only then: opening a pipe waits for somebody who writes into it
  if (std::filesystem::is_regular_file(file, ignored)) stream.open(file);
  if (!stream.is_open()) {
    throw InputError(file.string() +
                     ": cannot be read; name the pipeline file with --file, or see 'strake run "
                     "--help'");
  }
  try {
    if (const std::optional<YAML::Mark> second = second_document(stream)) {
      place_of(file, *second).fail("a second document begins; a pipeline is one");
    }
    stream.clear();
    stream.seekg(0);
    const YAML::Node top = YAML::Load(stream);
    return {place_of(file, top.Mark()), top};
  } catch (const YAML::Exception& error) {
    place_of(file, error.mark).fail("no YAML: " + error.msg);
  }
}

YamlView YamlView::below(const YAML::Node& node) const {
  return {place_of(place_.file, node.Mark()), node};
}

std::string YamlView::text(const char* what) const {
  if (!is_scalar()) fail(fmt::format("{} is needed here, a single value", what));
  return node_.Scalar();
}

std::vector<YamlView> YamlView::items(const char* what) const {
  if (!is_list()) fail(fmt::format("{} is needed here, a list", what));
  std::vector<YamlView> views;
  for (const YAML::Node& item : node_) views.push_back(below(item));
  return views;
}

std::vector<YamlView::Entry> YamlView::entries(const char* what) const {
  if (is_null()) return {};
  if (!is_map()) fail(fmt::format("{} is needed here, 'key: value' entries", what));
  std::vector<Entry> all;
  std::map<std::string, int> lines;
  for (const auto& pair : node_) {
    const YamlView key = below(pair.first);
    const std::string name = key.text("a name");
    if (name == kMergeKey) {
      key.fail(
          "merge keys ('<<') are not known here; write the entries out, or give all of a value "
          "an anchor");
    }
    const auto [seen, is_new] = lines.emplace(name, key.place().line);
    if (!is_new) key.fail(fmt::format("'{}' stands in line {} already", name, seen->second));
    // What is not written has no place of its own.
    const bool is_written = !pair.second.IsNull();
    all.push_back({name, key.place(), is_written ? below(pair.second) : YamlView(key.place(), {})});
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
