#pragma once

#include <string>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// The robustness of a run against its scenario's expectations.
struct RunRobustness {
  /// Smallest margin: positive if all expectations are met, negative if one is violated.
  double value = 0.0;
  std::string limit;  ///< Name of the decisive check: "mujoco: cross_track.max".
};

/// The smallest margin of all checks of the verdict. The margin of a check is
///
///   * for an upper limit (limit - value) / |limit|, for a lower limit (value - limit) / |limit|.
///     The division by |limit| makes limits of different units comparable. If the limit is 0, the
///     margin is the difference, in the unit of the metric;
///   * for a requirement over time, its robustness, in the unit of the decisive comparison;
///   * for a check without a numeric margin (arrived, no collision, an unmeasured metric), -1 if it
///     is not met, and undefined if it is met. A run without a plan has the margin -1;
///   * for the limit on the steering rate, which checks the simulation and not the driving, -1 if
///     it is not met, and undefined if it is met.
///
/// The robustness is 1 if all checks are met and none has a margin.
///
/// Guarantees: the robustness is finite. For a judged run, the robustness is negative if and only
/// if the verdict is not passed. A collision makes the robustness jump.
RunRobustness RobustnessOf(const RunResult& result);

}  // namespace trackbed
