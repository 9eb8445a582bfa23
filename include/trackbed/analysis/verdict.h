#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// The verdict on a run, with its list of checks.
namespace trackbed {

/// The required relation of a value to its bound.
enum class Relation { kAtMost, kAtLeast, kEquals };

/// Returns the name of a relation as written in metrics.json: "at_most", "at_least", "equals".
const char* ToString(Relation relation);

/// The reason for a check.
enum class CheckReason {
  kExpected,   ///< The scenario's `expect` contains the check.
  kArrival,    ///< Every run must arrive.
  kNoContact,  ///< Every run must touch no obstacle.
  kCorridor,   ///< On a path, the car must stay within one car width of the path.
  /// On a path, the car must not exceed the planned speed by more than its speed control can
  /// correct.
  kOverspeed,
  kSteeringRate,  ///< The steering rate must be within the actuator's limit.
  kCollision,     ///< `expect.collision` contains the check.
  kComparable,    ///< The station ranges of two compared plants must overlap.
  kSameEnd,       ///< Two compared runs must end with the same status.
  kRequirement,   ///< `expect.requirements` contains the check.
};

/// A bound and the value compared with it.
struct Check {
  std::string plant;
  std::string other;   ///< Second plant of a compared pair; else empty.
  std::string metric;  ///< Path of the metric in metrics.json: "cross_track.max", "position.max".
  Relation relation = Relation::kAtMost;
  /// Bound of the value; with kEquals, the text in the scenario: "true", "arrived", "3".
  MetricValue bound;
  /// Measured value. Monostate means that the value was not measured; the check is then not met.
  MetricValue value;
  MetricPlace at;  ///< Place in the run where the value was measured.
  bool met = false;

  CheckReason reason = CheckReason::kExpected;
  std::string name;  ///< Name of the metric in messages.
  std::string unit;  ///< Unit of bound and value; empty if dimensionless.
  /// Text added to the message, such as why the value is missing or why the car stopped.
  std::string detail;
  /// Formula of a requirement; empty for other checks. With a formula, the value is the robustness,
  /// and the bound is 0.
  std::string formula;
};

/// The name of the plant of a check, or "a – b" for two plants.
std::string PlantsOf(const Check& check);

/// The verdict on a run.
struct Verdict {
  bool judged = true;  ///< Whether the run had anything to check.
  bool passed = true;  ///< Whether the run was judged and no check failed.
  /// Failed checks, one line each, with value, bound, station and time.
  std::vector<std::string> failures;
  std::vector<std::string> notes;  ///< Additional remarks.
  std::vector<Check> checks;       ///< All checks, met or not.
};

/// Checks any metric of a plant by its path.
Check CheckMetric(const PlantMetrics& plant, const std::string& path, Relation relation,
                  const MetricValue& bound);

/// Checks whether a requirement is satisfied, which a robustness of 0 alone does not decide. A
/// requirement without robustness is not met.
Check CheckRequirement(const std::string& plant, const RequirementMetrics& requirement);

/// Makes one check per given bound. For two plants without common stations, makes a single check,
/// which is not met.
std::vector<Check> CheckBounds(const DifferenceBounds& bounds, const PlantComparison& comparison);

/// Returns the message of a check that is not met: metric, value, bound, station and time. The
/// message is empty if another check reports the same fault; for example, a contact also sets the
/// end status.
std::string FailureMessage(const Check& check);

/// Returns the messages of the checks of CheckBounds that are not met.
std::vector<std::string> Exceeded(const DifferenceBounds& bounds,
                                  const PlantComparison& comparison);

/// Adds the check to the verdict. If the check is not met, its message is added to the failures.
void AddCheck(Check check, Verdict& verdict);

/// Judges a run. Checks the scenario's expectations and, by default, for every plant:
///
///   * that the car arrives; an expected `status` or `collision: true` replaces this check,
///   * that the car touches no obstacle,
///   * on a path, that the car stays within one car width of the path (`max_cross_track` replaces
///     this check),
///   * on a path, that the car exceeds the planned speed by no more than its speed control can
///     correct (an expectation on `overspeed_max` replaces this check),
///   * that the steering rate of the wheels exceeds the actuator's limit by at most 3 %, which
///     allows for compliance; a higher rate means that the timestep is too long for the car.
///
/// A run that has no path, no obstacles and no expectations is not judged, and therefore has not
/// passed. Adds a note if the steering did not reach its command for more than 2 % of a maneuver.
Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons);

nlohmann::ordered_json ToJson(const Verdict& verdict);

}  // namespace trackbed
