#pragma once

#include <string>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// The robustness of a run against its scenario's expectations.
struct RunRobustness {
  double value = 0.0;  ///< positive: all are met with this margin; negative: violated
  std::string limit;   ///< the decisive check: "mujoco: cross_track.max"
};

/// The smallest margin of all checks of the verdict:
///   * of an upper limit (limit - value) / |limit|, of a lower limit (value - limit) / |limit|: a
///     fraction, so that limits of different units compare. If the limit is 0, the difference
///     itself, in the unit of the metric;
///   * of a requirement over time, its robustness, in the unit of the decisive comparison;
///   * of a check without a numeric margin (arrived, no collision, an unmeasured metric), and of a
///     run without a plan, -1 if it is not met; such a check has no margin if it is met;
///   * of the limit on the steering rate, which checks the simulation rather than the driving: -1
///     if it is not met, no margin if it is.
///
/// 1 if all checks are met and none has a margin.
///
/// Guarantees: finite; negative if and only if the verdict is not passed, for a run that was
/// judged. Not continuous: a collision is a step.
RunRobustness RobustnessOf(const RunResult& result);

}  // namespace trackbed
