#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace trackbed {

/// How a bisection ended.
enum class BisectStatus {
  kFound,        ///< Found the boundary between passing and failing values.
  kFailsAtFrom,  ///< Even the lowest value fails, so no boundary was found.
  kPassesAtTo,   ///< Even the highest value passes, so the boundary lies above the range.
  kInterrupted,  ///< The caller stopped the bisection.
};

/// Returns the name of a bisection's status as written in sweep.csv: "found", "fails_at_from", ….
const char* ToString(BisectStatus status);

/// One value that a bisection evaluated.
struct Trial {
  double value = 0.0;
  bool passed = false;

  bool operator==(const Trial&) const = default;
};

struct Bisection {
  BisectStatus status = BisectStatus::kInterrupted;
  double value = 0.0;  ///< Highest value that passed, if the status is kFound or kPassesAtTo.
  std::vector<Trial> trials;  ///< Values in order of evaluation.
};

/// Bisects for the highest value that passes. The value `from` should pass and `to` should fail.
/// Evaluates `from` and `to` first.
///
/// Guarantees: if the status is kFound, `value` passed, and a value at most `tolerance` above
/// `value` failed (or the next larger double failed, if that is further away). If several
/// boundaries exist between passing and failing values, the bisection finds one of them. Cost: at
/// most 2 + ceil(log2((to - from)/tolerance)) trials. The function `passes` returns nullopt to
/// interrupt the bisection. InternalError unless from < to and tolerance > 0.
Bisection Bisect(double from, double to, double tolerance,
                 const std::function<std::optional<bool>(double value)>& passes);

}  // namespace trackbed
