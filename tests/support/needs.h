#pragma once

#include <gtest/gtest.h>

#include <cstdlib>

namespace strake::support {

/// Whether environment variable CI is set: nothing that a test needs may be missing then.
inline bool runs_in_ci() {
  const char* set = std::getenv("CI");
  return set != nullptr && *set != '\0';
}

}  // namespace strake::support

/// Ends a test that cannot do without something: as failed in CI, as skipped elsewhere.
#define STRAKE_NEEDS(is_there, what)                                                \
  if (!(is_there) && ::strake::support::runs_in_ci()) FAIL() << "needs " << (what); \
  if (!(is_there)) GTEST_SKIP() << "needs " << (what)
