#include "trackbed/requirement/robustness.h"

#include <fmt/format.h>

#include <cmath>

#include "src/requirement/degree.h"
#include "trackbed/core/error.h"

// Computes the robustness of requirement formulas on the log of a run.
namespace trackbed {
namespace {

constexpr const char* kTimeColumn = "t_s";

using Numbers = std::vector<double>;

[[noreturn]] void FailOnLog(const std::string& message) {
  throw InputError(Problem{.message = message});
}

Numbers ReadTimes(const Table& log) {
  Numbers times = log.Column(kTimeColumn);
  if (times.empty()) {
    FailOnLog("the log has no rows");
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i])) {
      FailOnLog(fmt::format("{} is {} in row {}", kTimeColumn, times[i], i + 1));
    }
    if (i > 0 && times[i] <= times[i - 1]) {
      FailOnLog(fmt::format("{} must increase; after {} s comes {} s in row {}", kTimeColumn,
                            times[i - 1], times[i], i + 1));
    }
  }
  return times;
}

/// Evaluates a formula with a stack machine, for all samples of a log at once.
class Evaluation {
 public:
  Evaluation(const Formula& formula, const Table& log)
      : formula_(formula), log_(log), times_(ReadTimes(log)) {}

  Degrees Run() {
    for (const FormulaStep& step : formula_.steps()) {
      Take(step);
    }
    return Pop(conditions_);
  }

 private:
  template <typename T>
  static T Pop(std::vector<T>& stack) {
    T top = std::move(stack.back());
    stack.pop_back();
    return top;
  }

  /// Replaces the top two entries of a stack, numbers or conditions, by the result of `combine`.
  template <typename T, typename Combine>
  static void Reduce(std::vector<T>& stack, const Combine& combine) {
    const T right = Pop(stack);
    T& left = stack.back();
    for (std::size_t i = 0; i < left.size(); ++i) {
      left[i] = combine(left[i], right[i]);
    }
  }

  template <typename T, typename Change>
  static void Map(std::vector<T>& stack, const Change& change) {
    for (auto& one : stack.back()) {
      one = change(one);
    }
  }

  [[nodiscard]] std::string TextOf(const FormulaStep& step) const {
    return formula_.text().substr(step.begin, step.end - step.begin);
  }

  Numbers ReadSignal(const std::string& name) const {
    Numbers values = log_.Column(name);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i])) {
        FailOnLog(fmt::format("{} is {} at t = {} s", name, values[i], times_[i]));
      }
    }
    return values;
  }

  void Compare(const FormulaStep& step, double sign, bool or_equal) {
    const Numbers right = Pop(numbers_);
    const Numbers left = Pop(numbers_);
    Degrees degrees(times_.size());
    for (std::size_t i = 0; i < degrees.size(); ++i) {
      const double value = sign * (right[i] - left[i]);
      if (!std::isfinite(value)) {
        FailOnLog(fmt::format("'{}' compares {} with {} at t = {} s", TextOf(step), left[i],
                              right[i], times_[i]));
      }
      degrees[i] = {.value = value,
                    .row = static_cast<std::uint32_t>(i),
                    .satisfied = value > 0.0 || (or_equal && value == 0.0)};
    }
    conditions_.push_back(std::move(degrees));
  }

  [[nodiscard]] Windows WindowsOf(const FormulaStep& step) const {
    const double duration = times_.back() - times_.front();
    const auto resolve = [&](const WindowBound& bound) {
      return bound.from_end ? std::max(0.0, duration - bound.seconds) : bound.seconds;
    };
    return FindWindows(times_, resolve(step.from), resolve(step.to));
  }

  void Calculate(FormulaOperation operation) {
    switch (operation) {
      case FormulaOperation::kNegate:
        return Map(numbers_, [](double a) { return -a; });
      case FormulaOperation::kAbs:
        return Map(numbers_, [](double a) { return std::abs(a); });
      case FormulaOperation::kAdd:
        return Reduce(numbers_, [](double a, double b) { return a + b; });
      case FormulaOperation::kSubtract:
        return Reduce(numbers_, [](double a, double b) { return a - b; });
      case FormulaOperation::kMultiply:
        return Reduce(numbers_, [](double a, double b) { return a * b; });
      case FormulaOperation::kDivide:
        return Reduce(numbers_, [](double a, double b) { return a / b; });
      case FormulaOperation::kMin:  // std::min is not used, because it may ignore a NaN (not a
                                    // number)
        return Reduce(numbers_, [](double a, double b) { return std::isnan(a) || a < b ? a : b; });
      case FormulaOperation::kMax:
        return Reduce(numbers_, [](double a, double b) { return std::isnan(a) || a > b ? a : b; });
      default:
        TRACKBED_CHECK(false, "operation {} is not of numbers", static_cast<int>(operation));
    }
  }

  void Take(const FormulaStep& step) {
    switch (step.operation) {
      case FormulaOperation::kNumber:
        numbers_.emplace_back(times_.size(), step.number);
        return;
      case FormulaOperation::kSignal:
        numbers_.push_back(ReadSignal(formula_.signals()[step.signal]));
        return;
      case FormulaOperation::kLess:
        return Compare(step, 1.0, false);
      case FormulaOperation::kLessOrEqual:
        return Compare(step, 1.0, true);
      case FormulaOperation::kGreater:
        return Compare(step, -1.0, false);
      case FormulaOperation::kGreaterOrEqual:
        return Compare(step, -1.0, true);
      case FormulaOperation::kNot:
        return Map(conditions_, Not);
      case FormulaOperation::kAnd:
        return Reduce(conditions_, Min);
      case FormulaOperation::kOr:
        return Reduce(conditions_, Max);
      case FormulaOperation::kImplies:
        return Reduce(conditions_, [](const Degree& a, const Degree& b) { return Max(Not(a), b); });
      case FormulaOperation::kAlways:
        conditions_.back() = SlidingMin(conditions_.back(), WindowsOf(step));
        return;
      case FormulaOperation::kEventually:
        conditions_.back() = SlidingMax(conditions_.back(), WindowsOf(step));
        return;
      case FormulaOperation::kUntil: {
        const Degrees psi = Pop(conditions_);
        conditions_.back() = Until(conditions_.back(), psi, WindowsOf(step));
        return;
      }
      default:
        Calculate(step.operation);
    }
  }

  const Formula& formula_;
  const Table& log_;
  Numbers times_;
  std::vector<Numbers> numbers_;
  std::vector<Degrees> conditions_;
};

}  // namespace

FormulaResult Evaluate(const Formula& formula, const Table& log) {
  const Degree first = Evaluation(formula, log).Run().front();
  return {
      .robustness = first.value,
      .satisfied = first.satisfied,
      .row = first.row == Degree::kNoRow ? std::nullopt : std::optional<std::size_t>(first.row)};
}

double Robustness(const Formula& formula, const Table& log) {
  return Evaluate(formula, log).robustness;
}

std::vector<double> RobustnessOverTime(const Formula& formula, const Table& log) {
  std::vector<double> values;
  for (const Degree& degree : Evaluation(formula, log).Run()) {
    values.push_back(degree.value);
  }
  return values;
}

}  // namespace trackbed
