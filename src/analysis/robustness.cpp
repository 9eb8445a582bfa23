#include "trackbed/analysis/robustness.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <variant>

namespace trackbed {
namespace {

constexpr double kViolatedRobustness = -1.0;
constexpr double kSatisfiedRobustness = 1.0;

std::optional<double> NumberOf(const MetricValue& value) {
  if (const int* number = std::get_if<int>(&value)) {
    return *number;
  }
  const double* number = std::get_if<double>(&value);
  return number != nullptr && std::isfinite(*number) ? std::optional(*number) : std::nullopt;
}

/// Returns the margin of a check; nullopt if the check is met but has no numeric margin.
std::optional<double> ExtentOf(const Check& check) {
  const std::optional<double> bound = NumberOf(check.bound);
  const std::optional<double> value = NumberOf(check.value);
  const bool is_limit = check.relation != Relation::kEquals && bound && value &&
                        check.reason != CheckReason::kSteeringRate &&
                        check.reason != CheckReason::kOverspeed &&
                        check.reason != CheckReason::kOscillation;
  if (!is_limit) {
    return check.met ? std::nullopt : std::optional(kViolatedRobustness);
  }
  const double left = check.relation == Relation::kAtMost ? *bound - *value : *value - *bound;
  const double margin = *bound == 0.0 ? left : left / std::abs(*bound);
  // The margin of a violated check must be negative, but a strict requirement such as `x < y` is
  // violated at margin 0. For a violated strict requirement, the margin becomes the negative number
  // nearest to 0.
  return check.met ? margin : std::min(margin, -std::numeric_limits<double>::min());
}

}  // namespace

RunRobustness RobustnessOf(const RunResult& result) {
  if (!result.plan.ok()) {
    return {.value = kViolatedRobustness, .limit = "plan"};
  }
  std::optional<RunRobustness> least;
  for (const Check& check : result.verdict.checks) {
    const std::optional<double> margin = ExtentOf(check);
    if (margin && (!least || *margin < least->value)) {
      const std::string plants =
          check.other.empty() ? check.plant : check.plant + " - " + check.other;
      least = {.value = *margin, .limit = plants + ": " + check.metric};
    }
  }
  return least.value_or(RunRobustness{.value = kSatisfiedRobustness, .limit = {}});
}

}  // namespace trackbed
