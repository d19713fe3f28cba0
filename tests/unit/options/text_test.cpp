#include "common/core/text.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

TEST(Text, IsJoinedFromWords) {
  EXPECT_EQ(join_words({}), "");
  EXPECT_EQ(join_words({"one"}), "one");
  EXPECT_EQ(join_words({"one", "two", "three"}), "one, two, three");
  EXPECT_EQ(join_words({"one", "two"}, "|"), "one|two");
}

TEST(Text, GetsSmallLetters) {
  EXPECT_EQ(lower_case(".StL"), ".stl");
  EXPECT_EQ(lower_case("[AZ]_09"), "[az]_09");
  EXPECT_EQ(lower_case("\xC3\x84"), "\xC3\x84");  // of UTF-8, which keeps its bytes
}

}  // namespace
}  // namespace strake
