#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace trackbed {

/// How a bisection ended.
enum class BisectStatus {
  kFound,        ///< Answer found: between a value that passes and one that fails.
  kFailsAtFrom,  ///< Even the lowest value fails: there is no answer.
  kPassesAtTo,   ///< Even the highest value passes: the answer lies above.
  kInterrupted,  ///< The caller stopped the bisection.
};

/// The spelling of a bisection's status in sweep.csv: "found", "fails_at_from", ….
const char* ToString(BisectStatus status);

/// One value that a bisection evaluated.
struct Trial {
  double value = 0.0;
  bool passed = false;

  bool operator==(const Trial&) const = default;
};

struct Bisection {
  BisectStatus status = BisectStatus::kInterrupted;
  double value = 0.0;         ///< Highest value that passed; set with kFound or kPassesAtTo.
  std::vector<Trial> trials;  ///< Values in order of evaluation.
};

/// Bisects for the highest value that passes. The value `from` should pass and `to` should fail.
/// The values `from` and `to` are evaluated first.
///
/// Guarantees: with kFound, `value` passed and a value at most `tolerance` above it failed (or the
/// next double, if that is further). If passing is not monotonic, the bisection finds one of the
/// boundaries. Cost: at most 2 + ceil(log2((to - from)/tolerance)) trials. The function `passes`
/// returns nothing when interrupted. InternalError unless from < to and tolerance > 0.
Bisection Bisect(double from, double to, double tolerance,
                 const std::function<std::optional<bool>(double value)>& passes);

}  // namespace trackbed
