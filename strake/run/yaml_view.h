#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace strake {

/// A place in a text file, for messages.
struct Place {
  std::filesystem::path file;
  int line = 0;    ///< from 1; 0 on the command line, of which `file` is a part
  int column = 0;  ///< from 1

  /// Throws a UsageError that begins with "file:line:column: ", or "file: ".
  [[noreturn]] void fail(const std::string& message) const;
};

/// The nearest of `known` to a misspelt name, as " (did you mean 'x'?)"; "" if none is near.
std::string suggestion(std::string_view name, const std::vector<std::string>& known);

/// A strict view on YAML: every key must be known and stand once, and scalars stay the text that
/// was written (YAML's own rules take `no` for a truth value and `012` for ten).
class YamlView {
 public:
  /// \throw UsageError naming the line where the file is no YAML, InputError where it is missing
  static YamlView load(const std::filesystem::path& file);

  [[nodiscard]] const Place& place() const { return place_; }
  [[noreturn]] void fail(const std::string& message) const { place_.fail(message); }

  [[nodiscard]] bool is_null() const { return node_.IsNull(); }
  [[nodiscard]] bool is_scalar() const { return node_.IsScalar(); }
  [[nodiscard]] bool is_list() const { return node_.IsSequence(); }
  [[nodiscard]] bool is_map() const { return node_.IsMap(); }

  /// The text of a scalar. \param what  "a size", for the message where it is none
  [[nodiscard]] std::string text(const char* what) const;
  [[nodiscard]] std::vector<YamlView> items(const char* what) const;
  /// The entries of a map in the order of the file; an empty value where nothing is written.
  struct Entry;
  [[nodiscard]] std::vector<Entry> entries(const char* what) const;
  /// The entries of a map whose keys must be among `known`, by key.
  [[nodiscard]] std::map<std::string, YamlView> fields(const char* what,
                                                       const std::vector<std::string>& known) const;

 private:
  YamlView(Place place, YAML::Node node) : place_(std::move(place)), node_(std::move(node)) {}
  [[nodiscard]] YamlView below(const YAML::Node& node) const;

  Place place_;
  YAML::Node node_;
};

struct YamlView::Entry {
  std::string key;
  Place place;  ///< of the key
  YamlView value;
};

}  // namespace strake
