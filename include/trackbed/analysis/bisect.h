#pragma once

#include <functional>
#include <optional>
#include <vector>

namespace trackbed {

/// How a bisection ended.
enum class BisectStatus {
  kFound,        ///< between a value that passes and one that fails
  kFailsAtFrom,  ///< not even the lowest value passes: there is no answer
  kPassesAtTo,   ///< even the highest value passes: the answer lies above
  kInterrupted,  ///< the caller stopped it
};

/// "found", "fails_at_from", …: the spelling of sweep.csv.
const char* ToString(BisectStatus status);

/// One value that was tried.
struct Trial {
  double value = 0.0;
  bool passed = false;

  bool operator==(const Trial&) const = default;
};

struct Bisection {
  BisectStatus status = BisectStatus::kInterrupted;
  double value = 0.0;         ///< highest value that passed; set with kFound or kPassesAtTo
  std::vector<Trial> trials;  ///< in order of evaluation
};

/// Bisects for the highest value that passes, between `from`, which should pass, and `to`, which
/// should fail. Both are tried first.
///
/// Guarantees: with kFound, `value` passed and a value at most `tolerance` above it failed (or the
/// next double, if that is further). If passing is not monotonic, it finds one of the boundaries.
/// Cost: at most 2 + ceil(log2((to - from)/tolerance)) trials. `passes` returns nothing when
/// interrupted. InternalError unless from < to and tolerance > 0.
Bisection Bisect(double from, double to, double tolerance,
                 const std::function<std::optional<bool>(double value)>& passes);

}  // namespace trackbed
