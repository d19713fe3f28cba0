#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strake {

// Numbers as text, the same in every locale: a host of the library may have set one in which a
// comma divides the whole from its parts.

/// The finite number or whole number that is all of the text, which may begin with '+'.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_whole_number(std::string_view text);

/// The finite number that the text begins with, which is taken off it.
std::optional<double> take_number(std::string_view& text);

/// Shortest decimal text that reads back as the same number.
std::string number_text(double value);

}  // namespace strake
