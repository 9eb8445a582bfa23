#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "trackbed/core/error.h"
#include "trackbed/requirement/robustness.h"

namespace trackbed {
namespace {

using testing::HasSubstr;

// Compares random formulas with a reference evaluation. Formulas are made as trees and printed with
// the parentheses that the documented operator precedence requires. The reference evaluates the
// tree by the definitions, sample by sample and window by window. All times and bounds of the
// reference are whole numbers of ticks, so nothing is rounded.

constexpr double kTick = 0.05;  // [s]
constexpr double kNoSample = std::numeric_limits<double>::infinity();

struct Bound {
  int ticks = 0;
  bool from_end = false;
};

struct Node {
  std::string op;  // operator as in the text, or "number", "signal"
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
constexpr int kPrefix = 4;  // precedence of not, always, eventually
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
    // Binary operators are left associative, `implies` is right associative, and comparisons and
    // `until` do not associate.
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
  const T top = kTruth ? T(true) : T(kNoSample);
  const T bottom = kTruth ? T(false) : T(-kNoSample);
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

  /// Signals with many equal values, so that robustness is often 0; with uniform or nonuniform
  /// sampling.
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
        break;  // up to the end T
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

TEST(RandomFormulas, HaveTheRobustnessOfBruteForce) {
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
      // Exactly equal: both apply the same operations to the same doubles in the same order.
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
  // All cases occur.
  EXPECT_GT(zeros, 50);
  EXPECT_GT(infinite, 20);
  EXPECT_GT(satisfied, 500);
  EXPECT_LT(satisfied, 1500);
}

}  // namespace
}  // namespace trackbed
