#include "trackbed/requirement/robustness.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/error_text.h"
#include "tests/tolerance.h"
#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A log of one signal with one sample per second.
Table LogOf(const std::vector<double>& x) {
  Table log({"t_s", "x_m"});
  for (std::size_t i = 0; i < x.size(); ++i) {
    log.AddRow({static_cast<double>(i), x[i]});
  }
  return log;
}

FormulaResult ResultOf(const std::string& text, const Table& log) {
  return Evaluate(Formula::Parse(text, log.columns()), log);
}

std::vector<double> OverTime(const std::string& text, const Table& log) {
  return RobustnessOverTime(Formula::Parse(text, log.columns()), log);
}

std::string ErrorOf(const std::string& text, const Table& log) {
  return ErrorText([&] { static_cast<void>(ResultOf(text, log)); });
}

TEST(Robustness, IsTheDistanceOfAComparisonFromItsBound) {
  const Table log = LogOf({0.25, 3.0});
  EXPECT_EQ(ResultOf("x_m < 1", log).robustness, 0.75);
  EXPECT_EQ(ResultOf("x_m > 1", log).robustness, -0.75);
  EXPECT_EQ(ResultOf("x_m <= 1", log).robustness, 0.75);
  EXPECT_EQ(ResultOf("x_m >= 1", log).robustness, -0.75);
  EXPECT_EQ(ResultOf("2 * x_m - 1 / 4 + abs(-x_m) < min(x_m, 4) + max(1, 2, x_m)", log).robustness,
            2.25 - 0.5);
  EXPECT_EQ(Robustness(Formula::Parse("x_m < 1", log.columns()), log), 0.75);
}

TEST(Robustness, OfZeroHoldsForComparisonsThatIncludeEquality) {
  const Table log = LogOf({1.0});
  const auto satisfied = [&](const char* text) {
    const FormulaResult result = ResultOf(text, log);
    EXPECT_EQ(result.robustness, 0.0) << text;
    return result.satisfied;
  };
  EXPECT_TRUE(satisfied("x_m <= 1"));
  EXPECT_FALSE(satisfied("x_m < 1"));
  EXPECT_TRUE(satisfied("x_m >= 1"));
  EXPECT_FALSE(satisfied("always x_m > 1"));
  EXPECT_TRUE(satisfied("not x_m < 1"));
  EXPECT_FALSE(satisfied("x_m <= 1 and x_m < 1"));
  EXPECT_TRUE(satisfied("x_m < 1 or x_m <= 1"));
  EXPECT_TRUE(satisfied("x_m < 1 implies x_m < 1"));
}

TEST(Robustness, OfAlwaysIsThatOfTheWorstSampleAndNamesIt) {
  const Table log = LogOf({0.0, 2.0, 5.0, 5.0, 1.0});
  const FormulaResult all = ResultOf("always x_m < 4", log);
  EXPECT_EQ(all.robustness, -1.0);
  EXPECT_FALSE(all.satisfied);
  EXPECT_EQ(all.row, 2U);  // the earlier of two equal minima
  EXPECT_EQ(ResultOf("always[0, 1] x_m < 4", log).robustness, 2.0);
  EXPECT_EQ(ResultOf("always[T - 0.5, T] x_m < 4", log).robustness, 3.0);
  EXPECT_EQ(ResultOf("always[T - 99, T] x_m < 4", log).robustness, -1.0);
  EXPECT_EQ(ResultOf("eventually[1.5, 3.5] x_m > 4", log).row, 2U);
  EXPECT_THAT(OverTime("always[1, 2] x_m < 4", log), ElementsAre(-1.0, -1.0, -1.0, 3.0, kInfinity));
  EXPECT_THAT(OverTime("eventually[0, 1] x_m > 4", log), ElementsAre(-2.0, 1.0, 1.0, 1.0, -3.0));
}

TEST(Robustness, OfUntilDoesNotAskTheFirstConditionOfTheSampleThatEndsIt) {
  Table log({"t_s", "a_m", "b_m"});
  log.AddRow({0.0, 5.0, -1.0});
  log.AddRow({1.0, 3.0, -2.0});
  log.AddRow({2.0, -9.0, 4.0});
  EXPECT_EQ(ResultOf("a_m > 0 until b_m > 0", log).robustness, 3.0);
  EXPECT_EQ(ResultOf("a_m > 0 until[0, 1] b_m > 0", log).robustness, -1.0);
  EXPECT_EQ(ResultOf("a_m > 0 until[2, 2] b_m > 0", log).robustness, 3.0);
  EXPECT_EQ(ResultOf("a_m > 0 until[3, 9] b_m > 0", log).robustness, -kInfinity);
  EXPECT_EQ(ResultOf("b_m > 0 until a_m < 0", log).robustness, -2.0);
}

TEST(Robustness, OfAWindowBeyondTheLogIsInfiniteAndOfNoSample) {
  const Table log = LogOf({0.0, 1.0});
  const FormulaResult always = ResultOf("always[5, 9] x_m < 0", log);
  EXPECT_EQ(always.robustness, kInfinity);
  EXPECT_TRUE(always.satisfied);
  EXPECT_EQ(always.row, std::nullopt);
  const FormulaResult eventually = ResultOf("eventually[5, 9] x_m < 9", log);
  EXPECT_EQ(eventually.robustness, -kInfinity);
  EXPECT_FALSE(eventually.satisfied);
  EXPECT_EQ(eventually.row, std::nullopt);
}

TEST(Robustness, WindowsHoldWhatRoundingPutsAtTheirBounds) {
  // In floating point, 0.1 + 0.2 is not 0.3.
  Table log({"t_s", "x_m"});
  log.AddRow({0.1, 0.0});
  log.AddRow({0.3, 1.0});
  EXPECT_EQ(ResultOf("always[0, 0.2] x_m < 1", log).robustness, 0.0);
  EXPECT_EQ(ResultOf("eventually[0.2, 1] x_m > 0", log).robustness, 1.0);
}

TEST(Robustness, ErrorsNameTheSignalAndTheTime) {
  Table log({"t_s", "x_m", "y_m"});
  log.AddRow({0.0, 1.0, 0.0});
  log.AddRow({0.5, std::nan(""), 0.0});
  EXPECT_EQ(ErrorOf("always x_m < 1", log), "x_m is nan at t = 0.5 s");
  EXPECT_EQ(ErrorOf("always y_m < 1", log), "");  // the formula does not use x_m
  EXPECT_THAT(ErrorOf("always y_m / y_m < 1", log),
              MatchesRegex("'y_m / y_m < 1' compares -?nan with 1 at t = 0 s"));
  EXPECT_EQ(ErrorOf("always 1 / y_m < 1", log), "'1 / y_m < 1' compares inf with 1 at t = 0 s");
  EXPECT_THAT(ErrorOf("min(1, y_m / y_m) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("min(y_m / y_m, 1) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("max(1, y_m / y_m) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("max(y_m / y_m, 1) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("x_m < 1", LogOf({})), HasSubstr("the log has no rows"));
  Table twice({"t_s", "x_m"});
  twice.AddRow({1.0, 0.0});
  twice.AddRow({1.0, 0.0});
  EXPECT_EQ(ErrorOf("x_m < 1", twice), "t_s must increase; after 1 s comes 1 s in row 2");
  EXPECT_THROW(Robustness(Formula::Parse("z_m < 1", {"z_m"}), log), InputError);
}

TEST(Robustness, OfALongLogTakesTimeLinearInItsLength) {
  // The log has 200 000 samples, and the windows have half as many samples. Brute force would need
  // 2e10 comparisons per operator, which exceeds the test's time limit.
  Table log({"t_s", "x_m"});
  constexpr int kCount = 200000;
  for (int i = 0; i < kCount; ++i) {
    log.AddRow({i * 0.02, std::sin(i * 1e-3)});
  }
  const FormulaResult result = ResultOf(
      "always[0, 2000] eventually[0, 2000] (x_m > 0.5 until[100, 2000] x_m < -0.5 or x_m < 2)",
      log);
  EXPECT_TRUE(result.satisfied);
}

}  // namespace
}  // namespace trackbed
