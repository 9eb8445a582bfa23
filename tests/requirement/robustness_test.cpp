#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "tests/tolerance.h"
#include "trackbed/core/error.h"
#include "trackbed/requirement/formula.h"

namespace trackbed {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A log of one signal, a sample each second.
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
  try {
    static_cast<void>(ResultOf(text, log));
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
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
  EXPECT_EQ(all.row, 2U);  // the earlier of two
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
  // 0.1 + 0.2 is not 0.3.
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
  EXPECT_EQ(ErrorOf("always y_m < 1", log), "");  // x_m is not used
  EXPECT_EQ(ErrorOf("always y_m / y_m < 1", log),
            "'y_m / y_m < 1' compares -nan with 1 at t = 0 s");
  EXPECT_EQ(ErrorOf("always 1 / y_m < 1", log), "'1 / y_m < 1' compares inf with 1 at t = 0 s");
  EXPECT_THAT(ErrorOf("min(1, y_m / y_m) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("max(y_m / y_m, 1) < 1", log), HasSubstr("nan"));
  EXPECT_THAT(ErrorOf("x_m < 1", LogOf({})), HasSubstr("the log has no rows"));
  Table twice({"t_s", "x_m"});
  twice.AddRow({1.0, 0.0});
  twice.AddRow({1.0, 0.0});
  EXPECT_EQ(ErrorOf("x_m < 1", twice), "t_s must increase; after 1 s comes 1 s in row 2");
  EXPECT_THROW(Robustness(Formula::Parse("z_m < 1", {"z_m"}), log), InputError);
}

// The oracle: formulas are made as trees, printed with the parentheses that the documented order of
// operators asks for, and evaluated by the definitions, sample by sample and window by window.
// Times and bounds are whole ticks there, so that nothing is rounded.

constexpr double kTick = 0.05;  // [s]

struct Bound {
  int ticks = 0;
  bool from_end = false;
};

struct Node {
  std::string op;  // as in the text; "number", "signal"
  std::vector<Node> operands;
  double number = 0.0;
  bool bounded = false;
  Bound from;
  Bound to{.from_end = true};
};

struct Samples {
  std::vector<int> ticks;
  std::vector<double> a;
  std::vector<double> b;
};

const std::vector<std::vector<std::string>> kBinary{
    {"implies"}, {"or"}, {"and"}, {"until"}, {}, {"<", "<=", ">", ">="}, {"+", "-"}, {"*", "/"}};
constexpr int kPrefix = 4;  // not, always, eventually
constexpr int kSign = 8;
constexpr int kAtom = 9;

int LevelOf(const Node& node) {
  for (int level = 0; level < 8; ++level) {
    const auto& ops = kBinary[static_cast<std::size_t>(level)];
    if (std::find(ops.begin(), ops.end(), node.op) != ops.end()) {
      return level;
    }
  }
  return node.op == "not" || node.op == "always" || node.op == "eventually" ? kPrefix
         : node.op == "negate"                                              ? kSign
                                                                            : kAtom;
}

std::string Print(const Bound& bound) {
  const std::string seconds = fmt::format("{}", bound.ticks * kTick);
  return !bound.from_end ? seconds : bound.ticks == 0 ? "T" : "T - " + seconds;
}

std::string Print(const Node& node, int needed) {
  const int level = LevelOf(node);
  const auto own = [&]() -> std::string {
    const std::string window =
        node.bounded ? fmt::format("[{}, {}]", Print(node.from), Print(node.to)) : "";
    if (node.op == "number") {
      return fmt::format("{}", node.number);
    }
    if (node.op == "a_m" || node.op == "b_m") {
      return node.op;
    }
    if (node.op == "negate") {
      return "-" + Print(node.operands[0], kSign);
    }
    if (level == kPrefix) {
      return node.op + window + " " + Print(node.operands[0], kPrefix);
    }
    if (level == kAtom) {
      std::string arguments;
      for (const Node& operand : node.operands) {
        arguments += (arguments.empty() ? "" : ", ") + Print(operand, 0);
      }
      return node.op + "(" + arguments + ")";
    }
    // Left associative, but for `implies`; comparisons and `until` are not associative.
    const bool comparison = level == 5;
    const int left = node.op == "implies" || node.op == "until" || comparison ? level + 1 : level;
    const int right = node.op == "implies" ? level : level + 1;
    return Print(node.operands[0], left) + " " + node.op + window + " " +
           Print(node.operands[1], right);
  };
  return level < needed ? "(" + own() + ")" : own();
}

double NumberAt(const Node& node, const Samples& samples, std::size_t i) {
  const auto of = [&](std::size_t k) { return NumberAt(node.operands[k], samples, i); };
  if (node.op == "number")
    return node.number;
  if (node.op == "a_m")
    return samples.a[i];
  if (node.op == "b_m")
    return samples.b[i];
  if (node.op == "negate")
    return -of(0);
  if (node.op == "abs")
    return of(0) < 0.0 ? -of(0) : of(0);
  if (node.op == "min")
    return std::min({of(0), of(1), of(node.operands.size() - 1)});
  if (node.op == "max")
    return std::max({of(0), of(1), of(node.operands.size() - 1)});
  if (node.op == "+")
    return of(0) + of(1);
  if (node.op == "-")
    return of(0) - of(1);
  if (node.op == "*")
    return of(0) * of(1);
  return of(0) / of(1);
}

/// Robustness (`T` = double) or truth (`T` = bool) at every sample.
template <typename T>
std::vector<T> BruteForce(const Node& node, const Samples& samples) {
  constexpr bool kTruth = std::is_same_v<T, bool>;
  const T top = kTruth ? T(true) : T(kInfinity);
  const T bottom = kTruth ? T(false) : T(-kInfinity);
  const auto negated = [](T value) -> T {
    if constexpr (kTruth) {
      return !value;
    } else {
      return -value;
    }
  };
  std::vector<std::vector<T>> of;
  if (LevelOf(node) < 5) {
    for (const Node& operand : node.operands) {
      of.push_back(BruteForce<T>(operand, samples));
    }
  }
  const int end = samples.ticks.back() - samples.ticks.front();
  const auto ticks = [&](const Bound& bound) {
    return bound.from_end ? std::max(0, end - bound.ticks) : bound.ticks;
  };
  const auto in_window = [&](std::size_t i, std::size_t j) {
    const int after = samples.ticks[j] - samples.ticks[i];
    return j >= i && after >= ticks(node.from) && after <= ticks(node.to);
  };
  const std::size_t count = samples.ticks.size();
  std::vector<T> result(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (node.op == "not") {
      result[i] = negated(of[0][i]);
    } else if (node.op == "and") {
      result[i] = std::min<T>(of[0][i], of[1][i]);
    } else if (node.op == "or") {
      result[i] = std::max<T>(of[0][i], of[1][i]);
    } else if (node.op == "implies") {
      result[i] = std::max<T>(negated(of[0][i]), of[1][i]);
    } else if (node.op == "always") {
      T least = top;
      for (std::size_t j = 0; j < count; ++j) {
        least = in_window(i, j) ? std::min<T>(least, of[0][j]) : least;
      }
      result[i] = least;
    } else if (node.op == "eventually") {
      T most = bottom;
      for (std::size_t j = 0; j < count; ++j) {
        most = in_window(i, j) ? std::max<T>(most, of[0][j]) : most;
      }
      result[i] = most;
    } else if (node.op == "until") {
      T most = bottom;
      for (std::size_t j = 0; j < count; ++j) {
        if (in_window(i, j)) {
          T least = of[1][j];
          for (std::size_t k = i; k < j; ++k) {
            least = std::min<T>(least, of[0][k]);
          }
          most = std::max<T>(most, least);
        }
      }
      result[i] = most;
    } else {
      const double left = NumberAt(node.operands[0], samples, i);
      const double right = NumberAt(node.operands[1], samples, i);
      if constexpr (kTruth) {
        result[i] = node.op == "<"    ? left < right
                    : node.op == "<=" ? left <= right
                    : node.op == ">"  ? left > right
                                      : left >= right;
      } else {
        result[i] = node.op[0] == '<' ? right - left : left - right;
      }
    }
  }
  return result;
}

class FormulaMaker {
 public:
  explicit FormulaMaker(unsigned seed) : engine_(seed) {}

  int Int(int low, int high) { return std::uniform_int_distribution<int>(low, high)(engine_); }

  Node Condition(int depth) {
    if (depth == 0 || Int(0, 9) == 0) {
      const char* const comparisons[]{"<", "<=", ">", ">="};
      return {.op = comparisons[Int(0, 3)], .operands = {Number(2), Number(1)}};
    }
    const char* const ops[]{"not",    "and",    "or",         "implies",
                            "always", "always", "eventually", "until"};
    Node node{.op = ops[Int(0, 7)], .operands = {Condition(depth - 1)}};
    if (node.op == "and" || node.op == "or" || node.op == "implies" || node.op == "until") {
      node.operands.push_back(Condition(depth - 1));
    }
    if ((node.op == "always" || node.op == "eventually" || node.op == "until") && Int(0, 3) > 0) {
      SetWindow(node);
    }
    return node;
  }

  Node Number(int depth) {
    if (depth == 0 || Int(0, 3) == 0) {
      return Int(0, 3) == 0 ? Node{.op = "number", .number = Int(0, 8) * 0.25}
                            : Node{.op = Int(0, 1) == 0 ? "a_m" : "b_m"};
    }
    const char* const ops[]{"+", "-", "*", "/", "negate", "abs", "min", "max"};
    Node node{.op = ops[Int(0, 7)], .operands = {Number(depth - 1)}};
    if (node.op == "/") {
      node.operands.push_back({.op = "number", .number = Int(1, 4) * 0.5});
    } else if (node.op != "negate" && node.op != "abs") {
      node.operands.push_back(Number(depth - 1));
    }
    if ((node.op == "min" || node.op == "max") && Int(0, 1) == 0) {
      node.operands.push_back(Number(depth - 1));
    }
    return node;
  }

  /// Of values that are often equal, so that robustness is often 0; uniform, or not.
  Samples Signals() {
    Samples samples;
    const bool uniform = Int(0, 1) == 0;
    const int count = Int(1, 60);
    for (int i = 0, tick = Int(0, 3); i < count; ++i, tick += uniform ? 1 : Int(1, 4)) {
      samples.ticks.push_back(tick);
      samples.a.push_back(Int(-8, 8) * 0.25);
      samples.b.push_back(Int(-8, 8) * 0.25);
    }
    return samples;
  }

 private:
  void SetWindow(Node& node) {
    node.bounded = true;
    const int first = Int(0, 20);
    switch (Int(0, 4)) {
      case 0:
        node.from = {first};
        break;  // to T
      case 1:
        node.from = {first, true};
        node.to = {Int(0, first), true};
        break;
      default:
        node.from = {first};
        node.to = {first + Int(0, 20)};
    }
  }

  std::mt19937 engine_;
};

TEST(Robustness, EqualsThatOfBruteForceOn2000RandomFormulas) {
  int zeros = 0;
  int infinite = 0;
  int satisfied = 0;
  for (unsigned seed = 0; seed < 2000; ++seed) {
    FormulaMaker maker(seed);
    const Node node = maker.Condition(4);
    const Samples samples = maker.Signals();
    Table log({"t_s", "a_m", "b_m"});
    for (std::size_t i = 0; i < samples.ticks.size(); ++i) {
      log.AddRow({samples.ticks[i] * kTick, samples.a[i], samples.b[i]});
    }
    const std::string text = Print(node, 0);
    SCOPED_TRACE(fmt::format("seed {}: {}", seed, text));
    Formula formula;
    try {
      formula = Formula::Parse(text, log.columns());
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("the formula uses no signal"));
      continue;
    }
    const std::vector<double> expected = BruteForce<double>(node, samples);
    const std::vector<double> found = RobustnessOverTime(formula, log);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      // The same operations on the same doubles in the same order: without any rounding of its own.
      ASSERT_EQ(found[i], expected[i]) << i;
    }
    const FormulaResult result = Evaluate(formula, log);
    ASSERT_EQ(result.robustness, expected[0]);
    ASSERT_EQ(result.satisfied, BruteForce<bool>(node, samples)[0]);
    ASSERT_EQ(result.row.has_value(), std::isfinite(result.robustness));
    zeros += result.robustness == 0.0 ? 1 : 0;
    infinite += std::isinf(result.robustness) ? 1 : 0;
    satisfied += result.satisfied ? 1 : 0;
  }
  // All cases are among them.
  EXPECT_GT(zeros, 50);
  EXPECT_GT(infinite, 20);
  EXPECT_GT(satisfied, 500);
  EXPECT_LT(satisfied, 1500);
}

TEST(Robustness, OfALongLogTakesTimeLinearInItsLength) {
  // 200 000 samples and windows of half of them: by brute force 2e10 comparisons for each operator,
  // which would take the test's time limit.
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
