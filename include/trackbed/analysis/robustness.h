#pragma once

#include <string>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// The robustness with which a run meets the expectations of its scenario.
struct RunRobustness {
  /// Smallest margin of all checks: positive if all expectations are met, negative if an
  /// expectation is violated.
  double value = 0.0;
  /// Name of the check with the smallest margin, such as "mujoco: cross_track.max".
  std::string limit;
};

/// Computes the robustness: the smallest margin of all checks in the verdict. The margin of each
/// check is computed as follows.
///
///   * An upper limit has the margin (limit - value) / |limit|.
///   * A lower limit has the margin (value - limit) / |limit|. The division of a margin by |limit|
///     makes limits of different units comparable. If the limit is 0, the margin is the difference
///     between value and limit, in the unit of the metric.
///   * The margin of a requirement over time is the requirement's robustness, in the unit of the
///     comparison that determines the robustness.
///   * A check without a numeric margin (arrived, no collision, an unmeasured metric) has the
///     margin -1 if the check is not met, and no margin if the check is met. A run without a plan
///     has the margin -1.
///   * The check of the steering rate limit, which checks the simulation and not the driving, has
///     the margin -1 if the check is not met, and no margin if the check is met.
///
/// The robustness is 1 if all checks are met and no check has a margin.
///
/// Guarantees: the robustness is finite. For a judged run, the robustness is negative if and only
/// if the run has not passed. The robustness changes discontinuously when a run begins to have a
/// collision.
RunRobustness RobustnessOf(const RunResult& result);

}  // namespace trackbed
