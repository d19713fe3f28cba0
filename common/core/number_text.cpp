#include "common/core/number_text.h"

#include <charconv>
#include <cmath>

namespace strake {
namespace {

template <class Number>
std::optional<Number> take(std::string_view& text) {
  std::string_view digits = text;
  if (digits.size() > 1 && digits[0] == '+' && digits[1] != '-') digits.remove_prefix(1);
  Number value{};
  const char* const end = digits.data() + digits.size();
  const auto [read_to, error] = std::from_chars(digits.data(), end, value);
  if (error != std::errc()) return std::nullopt;
  text = {read_to, end};
  return value;
}

}  // namespace

std::optional<double> parse_number(std::string_view text) {
  const std::optional<double> value = take_number(text);
  return text.empty() ? value : std::nullopt;
}

std::optional<std::int64_t> parse_whole_number(std::string_view text) {
  const auto value = take<std::int64_t>(text);
  return text.empty() ? value : std::nullopt;
}

std::optional<double> take_number(std::string_view& text) {
  std::string_view rest = text;
  const auto value = take<double>(rest);
  if (!value || !std::isfinite(*value)) return std::nullopt;
  text = rest;
  return value;
}

std::string number_text(double value) {
  char buffer[32];
  const auto result = std::to_chars(buffer, buffer + sizeof buffer, value);
  return {buffer, result.ptr};
}

}  // namespace strake
