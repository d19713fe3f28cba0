#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace strake {

/// What a stage has to say about its run: counts, measures and warnings, in the order given.
///
/// Keys are dotted paths ("repairs.duplicate_faces") that become nested JSON objects.
class Report {
 public:
  using Value = std::variant<bool, std::int64_t, double, std::string>;

  void set(const std::string& key, bool value) { put(key, value); }
  void set(const std::string& key, std::int64_t value) { put(key, value); }
  void set(const std::string& key, int value) { put(key, std::int64_t{value}); }
  void set(const std::string& key, std::size_t value) {
    put(key, static_cast<std::int64_t>(value));
  }
  void set(const std::string& key, double value) { put(key, value); }
  void set(const std::string& key, std::string value) { put(key, std::move(value)); }
  void set(const std::string& key, const char* value) { put(key, std::string(value)); }
  /// A sentence for the user: something was repaired, dropped or explained.
  void warn(std::string sentence) { warnings_.push_back(std::move(sentence)); }

  [[nodiscard]] const std::vector<std::pair<std::string, Value>>& entries() const {
    return entries_;
  }
  /// A number, a count, or a flag as 0 or 1; nullopt where there is none of that name.
  [[nodiscard]] std::optional<double> number(std::string_view key) const {
    const auto entry = std::ranges::find(entries_, key, [](const auto& e) { return e.first; });
    if (entry == entries_.end()) return std::nullopt;
    if (const auto* real = std::get_if<double>(&entry->second)) return *real;
    if (const auto* count = std::get_if<std::int64_t>(&entry->second)) return double(*count);
    if (const auto* flag = std::get_if<bool>(&entry->second)) return *flag ? 1 : 0;
    return std::nullopt;
  }
  [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  void put(const std::string& key, Value value) {
    for (auto& entry : entries_) {
      if (entry.first == key) {
        entry.second = std::move(value);
        return;
      }
    }
    entries_.emplace_back(key, std::move(value));
  }

  std::vector<std::pair<std::string, Value>> entries_;
  std::vector<std::string> warnings_;
};

}  // namespace strake
