#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// How far a run is from violating one of its expectations.
struct ExpectationMargin {
  /// Name of the check: "mujoco cross_track.max", "kinematic – mujoco position.max".
  std::string name;
  std::string plant;  ///< Name of the plant, or "a – b" for the difference of two plants.
  /// Distance between value and bound: positive if the check is met, negative if violated. The
  /// margin of a requirement is its robustness. For contact with obstacles, it is the smallest
  /// clearance (0 on contact). For a number that must equal a bound, it is minus the distance from
  /// the bound. Nullopt for values without a distance (end status, truth value, text) and for
  /// unmeasured values.
  std::optional<double> margin;
  std::string unit;  ///< Unit of the margin; empty for requirements, and if there is no margin.
  bool met = false;  ///< Whether the check is met; decides if the margin is 0.
  MetricPlace at;    ///< Place of the value in the run.
};

/// Returns the margin of each check in the verdict, in the verdict's order. The list is empty for a
/// run without a plan. Margins of different units are not comparable.
std::vector<ExpectationMargin> Margins(const RunResult& result);

}  // namespace trackbed
