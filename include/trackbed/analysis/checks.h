#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// The checks of a run, with their messages.
namespace trackbed {

/// The relation that a value must have to its bound.
enum class Relation { kAtMost, kAtLeast, kEquals };

/// Returns the name of a relation as written in metrics.json: "at_most", "at_least" or "equals".
const char* ToString(Relation relation);

/// The reason why a check is made.
enum class CheckReason {
  kExpected,   ///< The scenario's `expect` contains the check.
  kArrival,    ///< Every run must arrive.
  kNoContact,  ///< The car must not touch an obstacle, in any run.
  kCorridor,   ///< If the run has a path, the car must stay within one car width of the path.
  /// If the run has a path, the car must not exceed the planned speed by more than its speed
  /// control can correct.
  kOverspeed,
  /// If the run has a path, the steering command must not keep oscillating.
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
  /// Text added to the message of the check, such as why the value is missing or why the car
  /// stopped.
  std::string detail;
  /// Formula of a requirement; empty for other checks. The check of a requirement has the
  /// robustness as its value, and the bound 0.
  std::string formula;
};

/// Returns the name of the plant that a check concerns, or "a – b" for a check of two plants a and
/// b.
std::string PlantsOf(const Check& check);

/// Makes a check of one metric of a plant. `path` is the path of the metric in metrics.json.
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

/// Returns a check as an entry of the list `verdict.checks` in metrics.json.
nlohmann::ordered_json ToJson(const Check& check);

}  // namespace trackbed
