#pragma once

#include <optional>
#include <string>
#include <vector>

#include "trackbed/analysis/run.h"

namespace trackbed {

/// How far a run is from violating one of its expectations.
struct ExpectationMargin {
  std::string name;  ///< of the check: "mujoco cross_track.max", "kinematic – mujoco position.max"
  std::string plant;  ///< the plant, or "a – b" for the difference of two
  /// Bound minus value, or value minus bound: positive if met, negative if violated. For a
  /// requirement, its robustness; for contact with obstacles, the smallest clearance (0 on
  /// contact); for a number that must equal a bound, minus the distance from it. None for values
  /// without a distance (end status, truth value, text) and for values that were not measured.
  std::optional<double> margin;
  std::string unit;  ///< of the margin; empty if there is no margin, and for requirements
  bool met = false;  ///< decides where the margin is 0
  MetricPlace at;    ///< where the value was
};

/// The margin of every check of the verdict, in its order: the checks of every run and those of
/// `expect`. Empty for a run without a plan. Margins of different units are not comparable.
std::vector<ExpectationMargin> Margins(const RunResult& result);

}  // namespace trackbed
