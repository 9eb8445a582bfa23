#include "trackbed/requirement/formula.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "trackbed/core/error.h"

namespace trackbed {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

const std::vector<std::string> kSignals{"t_s", "x_m", "y_m", "speed_mps"};

/// "column: message" of the error for a text; empty if the text is accepted.
std::string ErrorOf(const std::string& text) {
  try {
    Formula::Parse(text, kSignals);
  } catch (const InputError& error) {
    const Problem& problem = error.problems().front();
    return std::to_string(problem.column) + ": " + problem.message;
  }
  return "";
}

TEST(Formula, KnowsItsTextSignalsAndHorizon) {
  const auto parse = [](const char* text) { return Formula::Parse(text, kSignals); };
  const Formula formula = parse("always[0, 2] (abs(y_m) < x_m implies eventually[1, 3] x_m > 2)");
  EXPECT_EQ(formula.text(), "always[0, 2] (abs(y_m) < x_m implies eventually[1, 3] x_m > 2)");
  EXPECT_THAT(formula.signals(), ElementsAre("y_m", "x_m"));
  EXPECT_EQ(formula.horizon_s(), 5.0);
  EXPECT_EQ(parse("x_m < 1").horizon_s(), 0.0);
  EXPECT_EQ(parse("(always[0,4] x_m < 1) until[2,3] y_m > 0").horizon_s(), 7.0);
  EXPECT_EQ(parse("always[0,4] x_m < 1 and y_m > 0").horizon_s(), 4.0);
  EXPECT_TRUE(std::isinf(parse("eventually x_m < 1").horizon_s()));
  EXPECT_TRUE(std::isinf(parse("eventually[T - 1, T] x_m < 1").horizon_s()));
}

TEST(Formula, AcceptsSpacesParenthesesAndNumbersOfAllForms) {
  for (const char* text :
       {"x_m<1", "  x_m\t<\n1 ", "((x_m)) < ((1))", "(x_m < 1)", "x_m < .5e-3", "x_m < 2.E+2",
        "--x_m < -1", "not not x_m < 1", "min(x_m, y_m, 3) <= max(1, 2) * abs(-x_m / 4 - 1)",
        "x_m < 1 implies y_m < 1 implies speed_mps < 1", "always[ 0 , T ]x_m < 1",
        "eventually[T-2.5,T - 1] x_m < 1"}) {
    EXPECT_EQ(ErrorOf(text), "") << text;
  }
}

TEST(Formula, ToldByColumnWhatWasFoundAndWhatIsAllowed) {
  EXPECT_EQ(ErrorOf(""), "1: expected a condition, found the end");
  EXPECT_EQ(ErrorOf("  "), "3: expected a condition, found the end");
  EXPECT_EQ(ErrorOf("always[0, T] abs(x_n) < 0.5"),
            "18: unknown signal 'x_n'; did you mean 'x_m'?");
  EXPECT_EQ(ErrorOf("altitude < 1"),
            "1: unknown signal 'altitude'; allowed: t_s, x_m, y_m, speed_mps");
  EXPECT_EQ(ErrorOf("x_m <"), "6: expected a number or signal, found the end");
  EXPECT_EQ(ErrorOf("x_m < always y_m"), "7: expected a number or signal, found 'always'");
  EXPECT_EQ(ErrorOf("x_m < 1 && y_m < 1"), "9: expected an operator or the end, found '&'");
  EXPECT_EQ(ErrorOf("x_m == 1"), "5: expected an operator or the end, found '='");
  EXPECT_EQ(ErrorOf("x_m < 1 é"), "9: expected an operator or the end, found 'é'");
  EXPECT_EQ(ErrorOf("x_m < 1m"), "8: expected an operator or the end, found 'm'");
  EXPECT_EQ(ErrorOf("x_m < inf"), "7: unknown signal 'inf'; allowed: t_s, x_m, y_m, speed_mps");
  EXPECT_EQ(ErrorOf("(x_m < 1"), "9: expected ')', found the end");
  EXPECT_EQ(ErrorOf("x_m < 1)"), "8: expected an operator or the end, found ')'");
  EXPECT_EQ(ErrorOf("abs x_m < 1"), "5: expected '(', found 'x_m'");
  EXPECT_EQ(ErrorOf("min(x_m) < 1"), "8: expected ',', found ')'");
  EXPECT_EQ(ErrorOf("x_m < 1 and"), "12: expected a condition, found the end");
  EXPECT_EQ(ErrorOf("x_m < 1 until [0,1]"), "20: expected a condition, found the end");
  EXPECT_EQ(ErrorOf("always[0 1] x_m < 1"), "10: expected ',', found '1'");
  EXPECT_EQ(ErrorOf("always[-1, 1] x_m < 1"), "8: expected a time in seconds, or T, found '-'");
  EXPECT_EQ(ErrorOf("always[0, x_m] x_m < 1"), "11: expected a time in seconds, or T, found 'x_m'");
  EXPECT_EQ(ErrorOf("always[0, T - y_m] x_m < 1"), "15: expected a time in seconds, found 'y_m'");
  EXPECT_EQ(ErrorOf("always[0, 1) x_m < 1"), "12: expected ']', found ')'");
}

TEST(Formula, ToldWhatItMayNotMean) {
  EXPECT_EQ(ErrorOf("always[2, 1] x_m < 1"),
            "11: the second bound of a window must not be before the first");
  EXPECT_EQ(ErrorOf("always[T - 1, T - 2] x_m < 1"),
            "19: the second bound of a window must not be before the first");
  EXPECT_EQ(ErrorOf("always[0, 2e6] x_m < 1"),
            "11: 2000000 s is out of range; must be at most 1000000 s");
  EXPECT_EQ(ErrorOf("x_m < 1e999"), "7: 1e999 is not representable as a double");
  EXPECT_EQ(ErrorOf("0 < x_m < 1"), "9: comparisons cannot be chained; write 'a < x and x < b'");
  EXPECT_EQ(ErrorOf("x_m < 1 until y_m < 1 until t_s < 1"),
            "23: 'until' after 'until' needs parentheses");
  EXPECT_EQ(ErrorOf("x_m + 1"),
            "1: a formula must be a condition such as 'x < 1'; 'x_m + 1' is a number");
  EXPECT_EQ(ErrorOf("always (x_m)"),
            "8: 'always' needs conditions such as 'x < 1'; '(x_m)' is a number");
  EXPECT_EQ(ErrorOf("y_m < 1 and abs(x_m)"),
            "13: 'and' needs conditions such as 'x < 1'; 'abs(x_m)' is a number");
  EXPECT_EQ(ErrorOf("(x_m < 1) + 2 < 3"), "1: '+' needs numbers; '(x_m < 1)' is a condition");
  EXPECT_EQ(ErrorOf("abs(x_m < 1) < 3"), "5: 'abs' needs numbers; 'x_m < 1' is a condition");
  EXPECT_EQ(ErrorOf("1 < 2"), "1: the formula uses no signal");
}

TEST(Formula, HostileTextsAreErrorsAndTakeNoTime) {
  const auto repeated = [](const std::string& part, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) {
      text += part;
    }
    return text;
  };
  constexpr std::size_t kMany = 1300;
  for (const char* part : {"(", "-", "not ", "abs(", "always ", "x_m<1 implies ", "min(1,"}) {
    EXPECT_THAT(ErrorOf(repeated(part, Formula::kMaxLength / std::string(part).size())),
                HasSubstr("more than 50 parentheses and operators in each other"))
        << part;
  }
  EXPECT_THAT(ErrorOf(repeated("1", 5000)), HasSubstr("5000 bytes; at most 4096"));
  // A long formula may be shallow.
  EXPECT_EQ(ErrorOf("x_m < 1" + repeated("+1", kMany)), "");
  EXPECT_EQ(ErrorOf(repeated("x_m<1 or ", 450) + "x_m<1"), "");
  // The largest allowed depth.
  EXPECT_EQ(ErrorOf(repeated("(", 49) + "x_m" + repeated(")", 49) + " < 1"), "");
  EXPECT_THAT(ErrorOf(std::string("x_m < \0 1", 9)), HasSubstr("expected a number or signal"));
}

}  // namespace
}  // namespace trackbed
