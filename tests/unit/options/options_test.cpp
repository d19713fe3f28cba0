#include "common/core/options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "common/core/error.h"

namespace strake {
namespace {

/// The message of the UsageError that parsing gives; fails the test where there is none.
std::string refusal(const Option& option, const std::string& text) {
  try {
    option.parse_into(text);
  } catch (const UsageError& error) {
    EXPECT_EQ(error.code(), ExitCode::usage);
    return error.what();
  }
  ADD_FAILURE() << "'" << text << "' was accepted for --" << option.name;
  return "";
}

void expect_names(const std::string& message, const std::vector<std::string>& parts) {
  for (const std::string& part : parts) {
    EXPECT_NE(message.find(part), std::string::npos) << "'" << part << "' is not in: " << message;
  }
}

TEST(OtherValue, HoldsUntilTheEndOfItsScopeHoweverThatComes) {
  std::optional<std::int64_t> rounds;
  const Option option{"rounds", &rounds, "", "", 0, 9};
  {
    const OtherValue once(option, "1");
    EXPECT_EQ(rounds, 1);
    const OtherValue twice(option, "2");
    EXPECT_EQ(rounds, 2);
  }
  EXPECT_FALSE(rounds.has_value());
  rounds = 4;
  try {
    const OtherValue more(option, "7");
    throw AlgorithmError("no result");
  } catch (const AlgorithmError&) {
    EXPECT_EQ(rounds, 4);
  }
  EXPECT_THROW(OtherValue(option, "10"), UsageError);
  EXPECT_EQ(rounds, 4);
}

TEST(Length, ReadsSharesAndModelUnits) {
  EXPECT_EQ(Length::parse("0.1%"), (Length{0.001, true}));
  EXPECT_EQ(Length::parse("2.5"), (Length{2.5, false}));
  EXPECT_EQ(Length::parse("1e-3"), (Length{0.001, false}));
  EXPECT_DOUBLE_EQ(Length::parse("2%").resolve(50), 1);
  EXPECT_DOUBLE_EQ(Length::parse("2").resolve(50), 2);
}

TEST(Length, RefusesWhatIsNoLength) {
  for (const char* text : {"", "%", "abc", "1 %", "1%%", "1mm", "nan", "inf", "-inf%", "1e999"}) {
    EXPECT_THROW(Length::parse(text), UsageError) << text;
  }
}

TEST(Length, TextReadsBackToTheSameLength) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> exponent(-8, 3);
  for (int i = 0; i < 20000; ++i) {
    // Shares as `parse` makes them: not every number is a hundredth of another one.
    const double written = std::pow(10.0, exponent(random));
    const Length length = i % 2 == 0 ? percent(written) : Length{written, false};
    EXPECT_EQ(Length::parse(length.to_string()), length) << length.to_string();
  }
}

TEST(Length, TextIsAsPeopleWriteIt) {
  for (const char* text : {"0.1%", "0.05%", "0.3%", "1%", "50%", "100%", "7%", "2.5", "0.001"}) {
    EXPECT_EQ(Length::parse(text).to_string(), text);
  }
}

TEST(Option, ValueReadsBackForEveryType) {
  bool flag = true;
  std::int64_t count = -7;
  double number = 0.1;
  std::string text = "cross";
  Length length = percent(0.3);
  std::optional<std::int64_t> maybe_count = 12;
  std::optional<double> maybe_number;
  std::optional<Length> maybe_length = Length{3, false};
  const OptionList options = {{"flag", &flag, "", ""},
                              {"count", &count, "", ""},
                              {"number", &number, "", ""},
                              {"text", &text, "", ""},
                              {"length", &length, "length", ""},
                              {"maybe-count", &maybe_count, "", ""},
                              {"maybe-number", &maybe_number, "", ""},
                              {"maybe-length", &maybe_length, "length", ""}};
  std::vector<std::string> values;
  for (const Option& option : options) values.push_back(option.value());
  EXPECT_EQ(values,
            (std::vector<std::string>{"true", "-7", "0.1", "cross", "0.3%", "12", "", "3"}));

  flag = false;
  count = 0;
  number = 0;
  text = "";
  length = {};
  maybe_count.reset();
  maybe_number = 5;
  maybe_length.reset();
  for (std::size_t i = 0; i < options.size(); ++i) options[i].parse_into(values[i]);
  EXPECT_TRUE(flag);
  EXPECT_EQ(count, -7);
  EXPECT_EQ(number, 0.1);
  EXPECT_EQ(text, "cross");
  EXPECT_EQ(length, percent(0.3));
  EXPECT_EQ(maybe_count, 12);
  EXPECT_FALSE(maybe_number.has_value());
  EXPECT_EQ(maybe_length, (Length{3, false}));
}

TEST(Option, RefusesNumbersOutOfRangeAndKeepsTheOldValue) {
  double angle = 40;
  const Option option = {
      .name = "feature-angle", .target = &angle, .unit = "deg", .help = "", .min = 0, .max = 180};
  for (const char* text : {"-1", "180.5", "1e300"}) {
    expect_names(refusal(option, text),
                 {"--feature-angle", text, "a number", "between 0 and 180 deg"});
    EXPECT_EQ(angle, 40);
  }
  option.parse_into("180");
  EXPECT_EQ(angle, 180);
  option.parse_into("0");
  EXPECT_EQ(angle, 0);
}

TEST(Option, RefusesMalformedNumbers) {
  std::int64_t count = 3;
  const Option option = {.name = "iterations", .target = &count, .unit = "", .help = "", .min = 0};
  for (const char* text : {"", "x", "1.5", "1e3", " 1", "1 ", "0x10", "99999999999999999999"}) {
    expect_names(refusal(option, text), {"--iterations", "a whole number", "at least 0"});
    EXPECT_EQ(count, 3);
  }
}

TEST(Option, LimitsSharesButOnlyTheSignOfModelUnits) {
  Length radius = percent(1);
  const Option option = {
      .name = "radius", .target = &radius, .unit = "length", .help = "", .min = 0.0001, .max = 0.5};
  expect_names(refusal(option, "60%"), {"--radius", "60%", "between 0.01% and 50%"});
  expect_names(refusal(option, "0.001%"), {"--radius", "between 0.01% and 50%"});
  expect_names(refusal(option, "-3"), {"--radius", "greater than 0"});
  expect_names(refusal(option, "wide"), {"--radius", "wide", "0.5%", "model units"});
  option.parse_into("50%");
  EXPECT_EQ(radius, percent(50));
  option.parse_into("120");
  EXPECT_EQ(radius, (Length{120, false}));
}

TEST(CheckLengths, HoldsModelUnitsToTheSameShares) {
  std::optional<Length> radius = Length{0.6, false};
  const OptionList options = {{.name = "radius",
                               .target = &radius,
                               .unit = "length",
                               .help = "",
                               .min = 0.0001,
                               .max = 0.5}};
  const auto refused = [&](double diagonal) -> std::string {
    try {
      check_lengths(options, diagonal);
    } catch (const UsageError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_NE(refused(1).find("--radius: '0.6' is 60% of the bounding-box diagonal, 1; expected a "
                            "length between 0.01% and 50%"),
            std::string::npos)
      << refused(1);
  EXPECT_EQ(refused(2), "");
  EXPECT_EQ(refused(5999), "");
  EXPECT_NE(refused(6001), "");
  // The share of either limit is not the limit to the last digit.
  for (const double limit : {0.0001, 0.5}) {
    for (const double diagonal : {1e-30, 0.3, 7.7, 1e60}) {
      radius = Length{limit * diagonal, false};
      EXPECT_EQ(refused(diagonal), "") << diagonal;
    }
  }
  radius = percent(1);
  EXPECT_EQ(refused(1e-9), "");
  radius.reset();
  EXPECT_EQ(refused(1e-9), "");
}

TEST(Option, WritesLimitsOfCountsInDigits) {
  std::int64_t count = 5;
  const Option option = {
      .name = "vertices", .target = &count, .unit = "", .help = "", .min = 4, .max = 1e8};
  expect_names(refusal(option, "3"), {"between 4 and 100000000"});
}

TEST(Option, RefusesUnknownChoicesAndNamesTheKnownOnes) {
  std::string extension = "cross";
  const Option option = {.name = "extension",
                         .target = &extension,
                         .unit = "",
                         .help = "",
                         .choices = {"cross", "paper"}};
  expect_names(refusal(option, "papier"), {"--extension", "papier", "cross, paper"});
  EXPECT_EQ(extension, "cross");
  option.parse_into("paper");
  EXPECT_EQ(extension, "paper");
}

TEST(Option, RefusesWhatIsNeitherTrueNorFalse) {
  bool strict = false;
  const Option option = {.name = "strict", .target = &strict, .unit = "", .help = ""};
  expect_names(refusal(option, "maybe"), {"--strict", "maybe", "true or false"});
  option.parse_into("true");
  EXPECT_TRUE(strict);
}

}  // namespace
}  // namespace strake
