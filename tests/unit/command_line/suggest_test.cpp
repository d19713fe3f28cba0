#include "common/core/suggest.h"

#include <gtest/gtest.h>

namespace strake {
namespace {

const std::vector<std::string> kKnown = {
    "--vertices",      "--faces",         "--tolerance", "--fit-rounds",
    "--feature-angle", "--feature-edges", "remesh",      "run"};

TEST(NearestWord, UndoesEachKindOfSlip) {
  EXPECT_EQ(nearest_word("--vertces", kKnown), "--vertices");     // a letter too few
  EXPECT_EQ(nearest_word("--facees", kKnown), "--faces");         // too many
  EXPECT_EQ(nearest_word("--tolerence", kKnown), "--tolerance");  // another
  EXPECT_EQ(nearest_word("--tolreance", kKnown), "--tolerance");  // two swapped
  EXPECT_EQ(nearest_word("rn", {"nr"}), "nr");                    // a swap is one slip, not two
}

TEST(NearestWord, IsTheOnlyOneItBegins) {
  EXPECT_EQ(nearest_word("--fit", kKnown), "--fit-rounds");
  EXPECT_EQ(nearest_word("--feature", kKnown), "");  // two begin so
}

TEST(NearestWord, IsNoneWhereNothingIsNear) {
  EXPECT_EQ(nearest_word("--chocolate", kKnown), "");
  EXPECT_EQ(nearest_word("", kKnown), "");
  EXPECT_EQ(nearest_word("x", {}), "");
}

TEST(NearestWord, TakesTheNearestOfSeveral) {
  EXPECT_EQ(nearest_word("rum", {"remesh", "rug", "run", "rut"}), "rug");  // the first of equals
  EXPECT_EQ(nearest_word("--feature-edge", kKnown), "--feature-edges");
}

}  // namespace
}  // namespace strake
