#pragma once

#include <string>

namespace strake {

/// How fast work goes and how long it will take, for people: "12 %/s, 7 s left".
/// \param seconds   since it began
/// \param fraction  of it that is done, in [0, 1]
/// \return "" in the first second, and where too little is done to tell
std::string pace_text(double seconds, double fraction);

}  // namespace strake
