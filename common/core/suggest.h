#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace strake {

/// What was probably meant by a word that is not known: the known word that the fewest slips turn
/// into it (a letter too much, too few, another one, two swapped), or the only one it begins.
/// \return "" where none is near: at most one slip, and one more for each four letters
std::string nearest_word(std::string_view word, const std::vector<std::string>& known);

}  // namespace strake
