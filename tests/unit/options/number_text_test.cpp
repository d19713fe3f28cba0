#include "common/core/number_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

#include "common/core/options.h"

namespace strake {
namespace {

TEST(NumberText, ReadsWhatIsANumberAndNothingElse) {
  EXPECT_EQ(parse_number("-1.5e3"), -1500);
  EXPECT_EQ(parse_number("+0.25"), 0.25);
  for (const char* text : {"", "+", "+-1", "1,5", "1.5 ", " 1", "1e999", "inf", "nan", "0x10"}) {
    EXPECT_FALSE(parse_number(text)) << text;
  }
  EXPECT_EQ(parse_whole_number("9007199254740993"), 9007199254740993);
  EXPECT_EQ(parse_whole_number("+7"), 7);
  for (const char* text : {"", "7.0", "9223372036854775808", "7 "}) {
    EXPECT_FALSE(parse_whole_number(text)) << text;
  }
}

TEST(NumberText, TakesANumberOffTheText) {
  std::string_view text = "2.5 GB";
  EXPECT_EQ(take_number(text), 2.5);
  EXPECT_EQ(text, " GB");
  for (const std::string_view none : {" GB", "inf", ""}) {
    text = none;
    EXPECT_FALSE(take_number(text));
    EXPECT_EQ(text, none);
  }
}

TEST(NumberText, ReadsBackToTheSameNumber) {
  for (const double value : {0.1, 1.0 / 3, -2.5e-300, std::numeric_limits<double>::max()}) {
    EXPECT_EQ(parse_number(number_text(value)), value);
  }
}

TEST(Option, IsANumberWhereItHoldsOne) {
  std::int64_t count = 12;
  double angle = 0.5;
  std::optional<std::int64_t> wanted;
  std::optional<double> scale = 2.0;
  std::string text = "3";
  EXPECT_EQ((Option{.name = "count", .target = &count, .unit = "", .help = ""}.number()), 12);
  EXPECT_EQ((Option{.name = "angle", .target = &angle, .unit = "", .help = ""}.number()), 0.5);
  EXPECT_EQ((Option{.name = "wanted", .target = &wanted, .unit = "", .help = ""}.number()),
            std::nullopt);
  wanted = 2000000000;
  EXPECT_EQ((Option{.name = "wanted", .target = &wanted, .unit = "", .help = ""}.number()), 2e9);
  EXPECT_EQ((Option{.name = "scale", .target = &scale, .unit = "", .help = ""}.number()), 2);
  EXPECT_EQ((Option{.name = "text", .target = &text, .unit = "", .help = ""}.number()),
            std::nullopt);
}

}  // namespace
}  // namespace strake
