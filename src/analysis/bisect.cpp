#include "trackbed/analysis/bisect.h"

#include <numeric>

#include "trackbed/core/error.h"

namespace trackbed {

const char* ToString(BisectStatus status) {
  switch (status) {
    case BisectStatus::kFound:
      return "found";
    case BisectStatus::kFailsAtFrom:
      return "fails_at_from";
    case BisectStatus::kPassesAtTo:
      return "passes_at_to";
    case BisectStatus::kInterrupted:
      return "interrupted";
  }
  return "";
}

Bisection Bisect(double from, double to, double tolerance,
                 const std::function<std::optional<bool>(double value)>& passes) {
  TRACKBED_CHECK(from < to && tolerance > 0.0, "bisection from {} to {} within {}", from, to,
                 tolerance);
  Bisection bisection;
  const auto attempt = [&](double value) {
    const std::optional<bool> passed = passes(value);
    if (passed) {
      bisection.trials.push_back({value, *passed});
    }
    return passed;
  };
  const std::optional<bool> lowest = attempt(from);
  if (!lowest || !*lowest) {
    bisection.status = lowest ? BisectStatus::kFailsAtFrom : BisectStatus::kInterrupted;
    return bisection;
  }
  bisection.value = from;
  const std::optional<bool> highest = attempt(to);
  if (!highest || *highest) {
    bisection.status = highest ? BisectStatus::kPassesAtTo : BisectStatus::kInterrupted;
    bisection.value = to;
    return bisection;
  }
  double fails = to;
  while (fails - bisection.value > tolerance) {
    const double middle = std::midpoint(bisection.value, fails);
    if (middle <= bisection.value || middle >= fails) {
      break;  // stop the bisection, because no double lies between the two bounds
    }
    const std::optional<bool> passed = attempt(middle);
    if (!passed) {
      return bisection;
    }
    (*passed ? bisection.value : fails) = middle;
  }
  bisection.status = BisectStatus::kFound;
  return bisection;
}

}  // namespace trackbed
