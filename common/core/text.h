#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace strake {

/// Words one after the other, with something between them: "one, two, three".
std::string join_words(const std::vector<std::string>& words, std::string_view between = ", ");

/// A text with small letters for its capital ones, of ASCII only.
std::string lower_case(std::string_view text);

/// Whether a text holds line breaks, tabs or other control characters.
bool has_control_characters(std::string_view text);

/// Text that stays on one line: '?' for each control character.
std::string on_one_line(std::string text);

/// A text without the byte order mark that some editors put before UTF-8.
std::string_view without_byte_order_mark(std::string_view text);

}  // namespace strake
