#pragma once

#include <cstdint>
#include <string>

namespace strake {

/// What is counted.
enum class Counted { vertices, faces };

/// "vertices" or "faces": of the options that want so many, too.
const char* name_of(Counted counted);

/// Error of a wanted count above which the user is told.
inline constexpr double kCountTolerance = 0.05;

/// Share of the wanted count that another one is off by. \param wanted  positive
double count_miss(std::int64_t wanted, std::int64_t reached);

/// A count that a user asked for, and what came of it.
struct ReachedCount {
  Counted counted = Counted::vertices;
  std::int64_t wanted = 0;  ///< positive
  std::int64_t reached = 0;
  std::int64_t corners = 0;  ///< of feature and boundary lines, most of which stay
};

/// A sentence for the user where a wanted count is missed by more than `kCountTolerance`, else "".
/// \param what  that has the count: "the nearest result has"
/// \param why   it is missed, where corners are not the reason
std::string missed_count(const ReachedCount& count, const std::string& what,
                         const std::string& why);

}  // namespace strake
