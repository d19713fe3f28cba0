#include "common/core/options.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <type_traits>

#include "common/core/error.h"
#include "common/core/number_text.h"
#include "common/core/text.h"

namespace strake {
namespace {

std::optional<Length> parse_length(std::string_view text) {
  const bool relative = text.ends_with('%');
  if (relative) text.remove_suffix(1);
  const auto value = parse_number(text);
  if (!value) return std::nullopt;
  return Length{relative ? *value / 100 : *value, relative};
}

/// "between 0 and 180 deg", "at least 1", or "" where every number is allowed.
std::string range_text(const Option& option) {
  const std::string unit = option.unit.empty() || takes_length(option) ? "" : " " + option.unit;
  const auto limit = [&](double value) { return limit_text(option, value); };
  const bool has_min = std::isfinite(option.min);
  const bool has_max = std::isfinite(option.max);
  if (has_min && has_max)
    return "between " + limit(option.min) + " and " + limit(option.max) + unit;
  if (has_min) return "at least " + limit(option.min) + unit;
  if (has_max) return "at most " + limit(option.max) + unit;
  return "";
}

/// Parses one option's text; every refusal names the option, the text and what is allowed.
class Parser {
 public:
  Parser(const Option& option, std::string_view text) : option_(option), text_(text) {}

  void operator()(bool* target) const {
    if (text_ == "true") {
      *target = true;
    } else if (text_ == "false") {
      *target = false;
    } else {
      refuse("true or false");
    }
  }
  void operator()(std::int64_t* target) const {
    *target = in_range(parse_whole_number(text_), "a whole number");
  }
  void operator()(double* target) const { *target = in_range(parse_number(text_), "a number"); }
  void operator()(std::string* target) const {
    const auto& choices = option_.choices;
    if (!choices.empty() && std::find(choices.begin(), choices.end(), text_) == choices.end()) {
      refuse("one of " + join_words(choices));
    }
    *target = std::string(text_);
  }
  void operator()(Length* target) const {
    const auto length = parse_length(text_);
    if (!length) refuse(allowed(kLengthHelp));
    // Of a length in model units only the sign can be judged without a mesh.
    if (length->relative) {
      check_range(length->value, kLengthHelp);
    } else if (option_.min >= 0 && length->value <= 0) {
      refuse("a length greater than 0");
    }
    *target = *length;
  }
  template <class T>
  void operator()(std::optional<T>* target) const {
    if (text_.empty()) {
      target->reset();
      return;
    }
    T value{};
    (*this)(&value);
    *target = value;
  }

 private:
  static constexpr const char* kLengthHelp =
      "a length such as 0.5% (of the bounding-box diagonal) or 2.5 (model units)";

  template <class Number>
  Number in_range(const std::optional<Number>& value, const char* what) const {
    if (!value) refuse(allowed(what));
    check_range(static_cast<double>(*value), what);
    return *value;
  }
  void check_range(double value, const char* what) const {
    if (!(value >= option_.min && value <= option_.max)) refuse(allowed(what));
  }
  [[nodiscard]] std::string allowed(const std::string& what) const {
    const std::string range = range_text(option_);
    return range.empty() ? what : what + ", " + range;
  }
  [[noreturn]] void refuse(const std::string& expected) const {
    throw UsageError("option --" + option_.name + ": '" + std::string(text_) +
                     "' is not allowed; expected " + expected);
  }

  const Option& option_;
  std::string_view text_;
};

/// The length that an option holds; nullptr where it holds another thing, or nothing.
const Length* length_of(const Option& option) {
  if (const auto* target = std::get_if<Length*>(&option.target)) return *target;
  const auto* target = std::get_if<std::optional<Length>*>(&option.target);
  return target != nullptr && *target != nullptr && **target ? &***target : nullptr;
}

/// A number, or nothing.
template <class T>
std::optional<double> number_of(const T& value) {
  if constexpr (std::is_same_v<T, std::int64_t> || std::is_same_v<T, double>) {
    return static_cast<double>(value);
  } else {
    return std::nullopt;
  }
}
template <class T>
std::optional<double> number_of(const std::optional<T>& value) {
  return value ? number_of(*value) : std::nullopt;
}

std::string text_of(bool value) { return value ? "true" : "false"; }
std::string text_of(std::int64_t value) { return std::to_string(value); }
std::string text_of(double value) { return number_text(value); }
std::string text_of(const std::string& value) { return value; }
std::string text_of(const Length& value) { return value.to_string(); }
template <class T>
std::string text_of(const std::optional<T>& value) {
  return value ? text_of(*value) : "";
}

}  // namespace

bool takes_length(const Option& option) {
  return std::holds_alternative<Length*>(option.target) ||
         std::holds_alternative<std::optional<Length>*>(option.target);
}

std::string limit_text(const Option& option, double limit) {
  if (takes_length(option)) {
    std::array<char, 32> text{};
    constexpr int kDigits = 6;
    const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), 100 * limit,
                                            std::chars_format::general, kDigits);
    return std::string(text.data(), end) + "%";
  }
  constexpr double kMostDigits = 1e15;  // the shortest text of a hundred million is 1e+08
  const bool is_whole = std::floor(limit) == limit && std::abs(limit) < kMostDigits;
  return is_whole ? std::to_string(static_cast<std::int64_t>(limit)) : number_text(limit);
}

std::string Length::to_string() const {
  if (!relative) return number_text(value);
  // value * 100 may miss the number that was written by a rounding; the shortest that gives the
  // same value is right.
  const double scaled = value * 100;
  for (int digits = 1; digits <= 16; ++digits) {
    char buffer[40];
    const auto result =
        std::to_chars(buffer, buffer + sizeof buffer, scaled, std::chars_format::general, digits);
    const double rounded = parse_number({buffer, result.ptr}).value();
    if (rounded / 100 == value) return number_text(rounded) + "%";
  }
  for (const double towards : {-HUGE_VAL, HUGE_VAL}) {
    const double neighbour = std::nextafter(scaled, towards);
    if (neighbour / 100 == value) return number_text(neighbour) + "%";
  }
  return number_text(scaled) + "%";
}

Length Length::parse(std::string_view text) {
  const auto length = parse_length(text);
  if (!length) {
    throw UsageError("'" + std::string(text) +
                     "' is not a length; write a share of the bounding-box diagonal such as 0.5%, "
                     "or model units such as 2.5");
  }
  return *length;
}

std::string Option::value() const {
  return std::visit([](const auto* held) { return text_of(*held); }, target);
}

std::optional<double> Option::number() const {
  return std::visit([](const auto* held) { return number_of(*held); }, target);
}

void Option::parse_into(std::string_view text) const { std::visit(Parser(*this, text), target); }

void check_lengths(const OptionList& options, double diagonal) {
  constexpr double kRounding = 1e-9;  // of shares that were limits before they were model units
  for (const Option& option : options) {
    const Length* length = length_of(option);
    if (length == nullptr || length->relative || !(diagonal > 0)) continue;
    const double share = length->value / diagonal;
    if (share >= option.min * (1 - kRounding) && share <= option.max * (1 + kRounding)) continue;
    char shares[64];
    std::snprintf(shares, sizeof shares, "%.3g%% of the bounding-box diagonal, %.6g", 100 * share,
                  diagonal);
    throw UsageError("option --" + option.name + ": '" + length->to_string() + "' is " + shares +
                     "; expected a length " + range_text(option));
  }
}

}  // namespace strake
