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
  /// margin of a requirement is its robustness. For contact with obstacles, the margin is the
  /// smallest clearance (0 on contact). For a number that must equal a bound, the margin is minus
  /// the distance from the bound. The margin is nullopt for values without a distance (end status,
  /// truth value, text) and for unmeasured values.
  std::optional<double> margin;
  std::string unit;  ///< Unit of the margin; empty for requirements, and if there is no margin.
  bool met = false;  ///< Whether the check is met, which a margin of 0 alone does not tell.
  MetricPlace at;    ///< Place in the run where the value was measured.
};

/// Returns the margin of each check in the verdict, in the verdict's order. The list is empty for a
/// run without a plan. Margins of different units are not comparable.
std::vector<ExpectationMargin> Margins(const RunResult& result);

}  // namespace trackbed
