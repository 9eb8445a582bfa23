#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// The verdict on a run, with the list of all checks.
namespace trackbed {

/// The relation that a value must have to its bound.
enum class Relation { kAtMost, kAtLeast, kEquals };

/// Returns the name of a relation as written in metrics.json: "at_most", "at_least" or "equals".
const char* ToString(Relation relation);

/// The reason why a check is made.
enum class CheckReason {
  kExpected,   ///< The scenario's `expect` contains the check.
  kArrival,    ///< Every run must arrive.
  kNoContact,  ///< Every run must touch no obstacle.
  kCorridor,   ///< If the run has a path, the car must stay within one car width of the path.
  /// If the run has a path, the car must not exceed the planned speed by more than its speed
  /// control can correct.
  kOverspeed,
  /// If the run has a path, the steering command must not oscillate without an end.
  kOscillation,
  kSteeringRate,  ///< The steering rate must be within the actuator's limit.
  kCollision,     ///< The scenario contains the check in `expect.collision`.
  kComparable,    ///< The station ranges of two compared plants must overlap.
  kSameEnd,       ///< Two compared runs must end with the same status.
  kRequirement,   ///< The scenario contains the check in `expect.requirements`.
};

/// A check of a run: a bound, and the measured value that is compared with the bound.
struct Check {
  std::string plant;
  std::string other;   ///< Second plant, if the check concerns a pair of plants; else empty.
  std::string metric;  ///< Path of the checked metric in metrics.json, such as "cross_track.max".
  Relation relation = Relation::kAtMost;
  /// Bound on the value. With kEquals, the bound is the text in the scenario, such as "arrived".
  MetricValue bound;
  /// Measured value; std::monostate if the value was not measured. A check without a measured value
  /// is not met.
  MetricValue value;
  MetricPlace at;  ///< Part of the run (station and time) in which the value was measured.
  bool met = false;

  CheckReason reason = CheckReason::kExpected;
  std::string name;  ///< Name of the metric, for use in messages.
  std::string unit;  ///< Unit of the bound and the value; empty for dimensionless values.
  /// Text added to the message, such as why the value is missing or why the car stopped.
  std::string detail;
  /// Formula of a requirement; empty for other checks. The check of a requirement has the
  /// robustness as its value, and the bound 0.
  std::string formula;
};

/// Returns the name of the plant that a check concerns, or "a – b" for a check of two plants a and
/// b.
std::string PlantsOf(const Check& check);

/// The verdict on a run.
struct Verdict {
  /// Whether the run was judged, which requires that there was anything to check.
  bool judged = true;
  bool passed = true;  ///< Whether the run has passed: the run was judged, and no check failed.
  /// Failed checks, one line each, with value, bound, station and time.
  std::vector<std::string> failures;
  std::vector<std::string> notes;  ///< Additional remarks.
  std::vector<Check> checks;       ///< All checks of the run, whether met or not.
};

/// Makes a check of a plant's metric, which is selected by its path.
Check CheckMetric(const PlantMetrics& plant, const std::string& path, Relation relation,
                  const MetricValue& bound);

/// Checks whether a requirement is satisfied, because a robustness of 0 alone does not decide this.
/// The check of a requirement without robustness is not met.
Check CheckRequirement(const std::string& plant, const RequirementMetrics& requirement);

/// Makes one check for each of the given bounds on the differences of two plants. If the two plants
/// have no common stations, makes a single check, which is not met.
std::vector<Check> CheckBounds(const DifferenceBounds& bounds, const PlantComparison& comparison);

/// Returns the message of a check that is not met. The message states metric, value, bound, station
/// and time. The message is empty if another check reports the same fault; for example, a contact
/// with an obstacle is also reported by the check of the end status.
std::string FailureMessage(const Check& check);

/// Returns the messages of those checks of CheckBounds that are not met.
std::vector<std::string> Exceeded(const DifferenceBounds& bounds,
                                  const PlantComparison& comparison);

/// Adds a check to the verdict. If the check is not met, its message is added to the verdict's
/// failures.
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
