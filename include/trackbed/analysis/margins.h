#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// The margin by which a run meets or violates one of its expectations.
struct ExpectationMargin {
  /// Name of the check: plant and metric, such as "mujoco cross_track.max".
  std::string name;
  /// Name of the checked plant; "a – b" if the check concerns the difference of the plants a and b.
  std::string plant;
  /// Distance between the measured value and its bound: positive if the check is met, negative if
  /// the check is violated. The margin of a requirement is the robustness of the requirement. The
  /// margin of a check for contact with obstacles is the smallest clearance (0 on contact). If a
  /// number must equal its bound, the margin is minus the absolute difference of the two. The
  /// margin is nullopt if the value is not a number (end status, truth value, text) or was not
  /// measured.
  std::optional<double> margin;
  std::string unit;  ///< Unit of the margin; empty for a requirement, or if there is no margin.
  /// Whether the check is met; needed because a margin of 0 may mean either result.
  bool met = false;
  MetricPlace at;  ///< Station and time in the run at which the value was measured.
};

/// Returns the margin of each check in the verdict, in the verdict's order; an empty list for a run
/// without a plan. Margins of different units are not comparable.
std::vector<ExpectationMargin> Margins(const RunResult& result);

}  // namespace trackbed
