#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_value.h"
#include "trackbed/analysis/metrics.h"
#include "trackbed/scenario/scenario.h"

/// Whether a run did what its scenario expects, as a list of checks.
namespace trackbed {

/// How a value is to stand to its bound.
enum class Relation { kAtMost, kAtLeast, kEquals };

/// "at_most", "at_least", "equals": the spelling of metrics.json.
const char* ToString(Relation relation);

/// Why something was checked.
enum class CheckReason {
  kExpected,      ///< the scenario's `expect` says so
  kArrival,       ///< every run is to arrive
  kNoContact,     ///< and to touch no obstacle
  kCorridor,      ///< on a path, to stay within one car width of it
  kSteeringRate,  ///< and no wheels turn faster than their actuator
  kCollision,     ///< `expect.collision`
  kComparable,    ///< two plants that are compared both drove some stretch
  kSameEnd,       ///< two runs that are compared ended alike
};

/// One bound and the value that was held against it.
struct Check {
  std::string plant;
  std::string other;   ///< the second one of a pair that is compared; else empty
  std::string metric;  ///< its path in metrics.json: "cross_track.max", "position.max"
  Relation relation = Relation::kAtMost;
  MetricValue bound;  ///< with kEquals, a text as the scenario has it: "true", "arrived", "3"
  MetricValue value;  ///< monostate: there was none, and the check is not met
  MetricPlace at;     ///< where the value was
  bool met = false;

  CheckReason reason = CheckReason::kExpected;
  std::string name;    ///< of the metric, in messages
  std::string unit;    ///< of bound and value; empty for none
  std::string detail;  ///< what the message says beside that: why there is no value, why it stopped
};

/// Did the run do what its scenario expects?
struct Verdict {
  bool judged = true;                 ///< something was asked of it
  bool passed = true;                 ///< it was, and nothing failed
  std::vector<std::string> failures;  ///< expected, actual, where and when; one line each
  std::vector<std::string> notes;     ///< what to know of a run beside whether it passed
  std::vector<Check> checks;          ///< all that was checked, met or not
};

/// Checks any metric of a plant by its path.
Check CheckMetric(const PlantMetrics& plant, const std::string& path, Relation relation,
                  const MetricValue& bound);

/// A check for each bound that is given. Drives without a stretch in common have one check alone,
/// which is not met.
std::vector<Check> CheckBounds(const DifferenceBounds& bounds, const PlantComparison& comparison);

/// What is said of a check that is not met: what was expected, what was, where and when. Empty
/// where another check says the same: a contact is part of how a run ended.
std::string FailureMessage(const Check& check);

/// The messages of CheckBounds.
std::vector<std::string> Exceeded(const DifferenceBounds& bounds,
                                  const PlantComparison& comparison);

/// Adds the check, and its message to the failures if it is not met.
void AddCheck(Check check, Verdict& verdict);

/// Asks what the scenario expects, and unless that says otherwise of every plant:
///   * that it arrives; another `status` among the metrics or `collision: true` replaces that,
///   * that it touches no obstacle,
///   * on a path, that it stays within one car width of it (`max_cross_track` replaces that),
///   * that its wheels turned no faster than its actuator can, but for what their compliance adds
///     (3 %): faster ones mean that the timestep is too long for the car.
/// A run without a path, obstacles and expectations has been asked nothing: it is not judged, and
/// has not passed. Notes tell of a manoeuvre in which the steering did not reach its command for
/// more than 2 % of the time.
Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons);

nlohmann::ordered_json ToJson(const Verdict& verdict);

}  // namespace trackbed
