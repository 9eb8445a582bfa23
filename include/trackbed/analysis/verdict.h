#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/checks.h"
#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// The verdict on a run, with the list of all checks.
namespace trackbed {

/// The verdict on a run.
struct Verdict {
  /// Whether the run was judged, which requires at least one check.
  bool judged = true;
  bool passed = true;  ///< Whether the run has passed: the run was judged, and no check failed.
  /// Failed checks, one line each, with value, bound, station and time.
  std::vector<std::string> failures;
  std::vector<std::string> notes;  ///< Additional remarks.
  std::vector<Check> checks;       ///< All checks of the run, whether met or not.
};

/// Adds a check to the verdict. If the added check is not met, its message becomes one of the
/// verdict's failures.
void AddCheck(Check check, Verdict& verdict);

/// Judges a run. Checks the scenario's expectations and makes the following default checks for
/// every plant.
///
///   * The car must arrive; an expected `status` or `collision: true` replaces this check.
///   * The car must touch no obstacle.
///   * If the run has a path, the car must stay within one car width of the path; `max_cross_track`
///     replaces this check.
///   * If the run has a path, the car must not exceed the planned speed by more than its speed
///     control can correct; an expectation on `overspeed_max` replaces this check.
///   * If the run has a path, the steering command must not oscillate without an end; a bound on
///     `oscillation.amplitude` replaces this check.
///   * The steering rate of the wheels must exceed the actuator's limit by at most 3 %, which
///   allows
///     for compliance. A higher steering rate means that the timestep is too long for the car.
///
/// A run that has no path, no obstacles and no expectations is not judged, and therefore has not
/// passed. Adds a note if the steering did not reach the commanded angle during more than 2 % of a
/// maneuver.
Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons);

nlohmann::ordered_json ToJson(const Verdict& verdict);

}  // namespace trackbed
