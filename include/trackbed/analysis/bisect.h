#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace trackbed {

/// The result status of a bisection.
enum class BisectStatus {
  kFound,        ///< The bisection found the boundary between passing and failing values.
  kFailsAtFrom,  ///< Even the lowest value fails, so no boundary was found.
  kPassesAtTo,   ///< Even the highest value passes, so the boundary lies above the range.
  kInterrupted,  ///< The caller stopped the bisection.
};

/// Returns the name of a bisection's status, as written in sweep.csv, such as "found".
const char* ToString(BisectStatus status);

/// One value that a bisection evaluated.
struct Trial {
  double value = 0.0;
  bool passed = false;

  bool operator==(const Trial&) const = default;
};

struct Bisection {
  BisectStatus status = BisectStatus::kInterrupted;
  /// Highest value that passed; only set if the status is kFound or kPassesAtTo.
  double value = 0.0;
  std::vector<Trial> trials;  ///< All evaluated values, in the order of their evaluation.
};

/// Searches for the highest value that passes, by bisection. The caller should choose the range so
/// that the value `from` passes and the value `to` fails. Evaluates `from` and `to` first.
///
/// Guarantees: if the status is kFound, `value` passed, and a tested value at most `tolerance`
/// above `value` failed. If `tolerance` is below the spacing of double values, the next larger
/// double failed. If several boundaries exist between passing and failing values, the bisection
/// finds one of them. Cost: at most 2 + ceil(log2((to - from)/tolerance)) trials. The function
/// `passes` returns nullopt to interrupt the bisection. Throws InternalError unless from < to and
/// tolerance > 0.
Bisection Bisect(double from, double to, double tolerance,
                 const std::function<std::optional<bool>(double value)>& passes);

}  // namespace trackbed
