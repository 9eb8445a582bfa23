#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// Verdict on a run: the list of checks.
namespace trackbed {

/// The required relation of a value to its bound.
enum class Relation { kAtMost, kAtLeast, kEquals };

/// "at_most", "at_least", "equals": the spelling of metrics.json.
const char* ToString(Relation relation);

/// The reason for a check.
enum class CheckReason {
  kExpected,      ///< the scenario's `expect` says so
  kArrival,       ///< every run must arrive
  kNoContact,     ///< every run must touch no obstacle
  kCorridor,      ///< on a path, stay within one car width of it
  kOverspeed,     ///< on a path, no faster than the speed control can correct
  kSteeringRate,  ///< steering rate within the actuator's limit
  kCollision,     ///< `expect.collision`
  kComparable,    ///< the station ranges of two compared plants overlap
  kSameEnd,       ///< two compared runs ended with the same status
  kRequirement,   ///< `expect.requirements`
};

/// A bound and the value compared with it.
struct Check {
  std::string plant;
  std::string other;   ///< the second plant of a compared pair; else empty
  std::string metric;  ///< its path in metrics.json: "cross_track.max", "position.max"
  Relation relation = Relation::kAtMost;
  MetricValue bound;  ///< with kEquals, a text as the scenario has it: "true", "arrived", "3"
  MetricValue value;  ///< monostate: not measured, and the check is not met
  MetricPlace at;     ///< where the value was
  bool met = false;

  CheckReason reason = CheckReason::kExpected;
  std::string name;  ///< of the metric, in messages
  std::string unit;  ///< of bound and value; empty if dimensionless
  std::string
      detail;  ///< additional text of the message: why there is no value, why the car stopped
  std::string formula;  ///< of a requirement; its value is the robustness, its bound 0
};

/// The plant of a check, or "a – b".
std::string PlantsOf(const Check& check);

/// The verdict on a run.
struct Verdict {
  bool judged = true;                 ///< whether there was anything to check
  bool passed = true;                 ///< judged, and no check failed
  std::vector<std::string> failures;  ///< one line each, with value, bound, station and time
  std::vector<std::string> notes;     ///< additional remarks
  std::vector<Check> checks;          ///< all that was checked, met or not
};

/// Checks any metric of a plant by its path.
Check CheckMetric(const PlantMetrics& plant, const std::string& path, Relation relation,
                  const MetricValue& bound);

/// Checks whether a requirement is satisfied; a robustness of 0 alone does not decide that. A
/// requirement without robustness is not met.
Check CheckRequirement(const std::string& plant, const RequirementMetrics& requirement);

/// One check per given bound. Plants without common stations give a single check, which is not met.
std::vector<Check> CheckBounds(const DifferenceBounds& bounds, const PlantComparison& comparison);

/// The message of a check that is not met: metric, value, bound, station and time. Empty if another
/// check reports the same fault: a contact also sets the end status.
std::string FailureMessage(const Check& check);

/// The messages of CheckBounds.
std::vector<std::string> Exceeded(const DifferenceBounds& bounds,
                                  const PlantComparison& comparison);

/// Adds the check, and its message to the failures if it is not met.
void AddCheck(Check check, Verdict& verdict);

/// Checks the scenario's expectations and, unless these say otherwise, for every plant:
///   * that it arrives; an expected `status` or `collision: true` replaces that,
///   * that it touches no obstacle,
///   * on a path, that it stays within one car width of it (`max_cross_track` replaces that),
///   * on a path, that it is nowhere faster than planned by more than its speed control can correct
///     (an expectation on `overspeed_max` replaces that),
///   * that its wheels turned no faster than the actuator allows, plus 3 % for their compliance;
///     faster wheels mean that the timestep is too long for the car.
///
/// A run without a path, obstacles and expectations is not judged, and has not passed. Adds a note
/// for a maneuver in which the steering did not reach its command for more than 2 % of the time.
Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons);

nlohmann::ordered_json ToJson(const Verdict& verdict);

}  // namespace trackbed
