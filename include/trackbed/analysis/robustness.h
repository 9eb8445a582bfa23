#pragma once

#include <string>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// How far a run is from breaking what its scenario expects of it.
struct RunRobustness {
  double value = 0.0;  ///< above 0: all is met, with so much to spare; below 0: not
  std::string limit;   ///< what decides: "mujoco: cross_track.max"
};

/// The smallest margin of all checks of the verdict:
///   * of a limit, (limit - value) / |limit|, or (value - limit) / |limit| where it is a lower one:
///     the share of the limit that is left, so that those of different units compare. Where the
///     limit is 0 it is the difference itself, in the unit of the metric;
///   * of a requirement over time, its robustness, in the unit of the comparison that decides;
///   * of a check that no number says the extent of (arrived, no collision, a metric that was not
///     measured), and of a run without a plan, -1 where it is not met, and nothing where it is;
///   * of the steering rate of the wheels, whose limit is one of the simulation, likewise.
/// 1 where all is met and no number says by how much.
///
/// Guarantees: finite; negative if and only if the verdict is not passed, for a run that was
/// judged. Not continuous: a collision is a step.
RunRobustness RobustnessOf(const RunResult& result);

}  // namespace trackbed
