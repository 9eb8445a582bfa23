#include "trackbed/analysis/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

// Computes the verdict on a run. Each plant (car model) must arrive without a collision, or collide
// if the scenario expects a collision. Each plant must not exceed the steering rate limit of the
// actuator, must stay within the default corridor of one car width, and must not oscillate. Each
// plant must also meet the expectations and requirements on the plant, and the bounds on its
// difference from other plants. Explicit expectations replace the default expectations on status
// and cross-track error. Every check is recorded in the verdict, whether or not the check is met. A
// run without expectations, plan and obstacles gets a verdict only if at least one check fails.
namespace trackbed {
namespace {

/// Fraction by which the measured steering rate may exceed the rate limit of the actuator.
constexpr double kWheelCompliance = 0.03;

bool HasExpectationFor(std::string_view metric, const PlantExpectation& expect) {
  return std::any_of(expect.metrics.begin(), expect.metrics.end(),
                     [&](const MetricExpectation& own) { return own.metric == metric; });
}

bool HasExpectations(const PlantExpectation& expect) {
  return expect.reach_goal || expect.max_cross_track || expect.rms_cross_track ||
         expect.max_heading_error || expect.max_hitch_angle || expect.min_clearance ||
         expect.collision || !expect.metrics.empty() || !expect.requirements.empty();
}

bool HasExpectations(const Expectations& expect) {
  return HasExpectations(expect.all) || !expect.between.empty() ||
         std::any_of(expect.plants.begin(), expect.plants.end(),
                     [](const auto& own) { return HasExpectations(own.second); });
}

/// Explains why a run ended before the goal. The explanation of an early end is appended to the
/// failure message.
std::string EarlyEndReason(const PlantMetrics& metrics) {
  return !metrics.blocked.empty()   ? fmt::format(" (it {})", metrics.blocked)
         : !metrics.partial.empty() ? fmt::format(" (the plan {})", metrics.partial)
         : !metrics.cause.empty()   ? fmt::format(" ({})", metrics.cause)
                                    : "";
}

/// The expectations that apply to one plant: first the expectations on all plants, then the
/// expectations on this plant alone.
class Expected {
 public:
  Expected(const Expectations& expect, const std::string& plant) {
    parts_.push_back(&expect.all);
    for (const auto& [name, own] : expect.plants) {
      if (name == plant) {
        parts_.push_back(&own);
      }
    }
  }

  [[nodiscard]] const std::vector<const PlantExpectation*>& parts() const { return parts_; }

  [[nodiscard]] bool HasMetric(std::string_view metric) const {
    return std::any_of(parts_.begin(), parts_.end(), [&](const PlantExpectation* part) {
      return HasExpectationFor(metric, *part);
    });
  }

  /// Returns whether the scenario expects a collision, or nullopt if the scenario does not specify
  /// it.
  [[nodiscard]] std::optional<bool> Collision() const {
    std::optional<bool> collision;
    for (const PlantExpectation* part : parts_) {
      collision = part->collision ? part->collision : collision;
    }
    return collision;
  }

  [[nodiscard]] bool HasCrossTrack() const {
    return std::any_of(parts_.begin(), parts_.end(), [](const PlantExpectation* part) {
      return part->max_cross_track.has_value();
    });
  }

 private:
  std::vector<const PlantExpectation*> parts_;
};

/// Checks that the run arrives at the goal or ends in the expected collision. JudgeEnd returns true
/// if the run ends as expected, or if the scenario has an expectation on the metric `status`.
bool JudgeEnd(const Expected& expected, const PlantMetrics& metrics, Verdict& verdict) {
  if (expected.HasMetric("status")) {
    return true;
  }
  const bool collides =
      expected.Collision().value_or(false) && metrics.status == DriveStatus::kCollided;
  Check arrival = CheckMetric(metrics, "status", Relation::kEquals,
                              ToString(collides ? DriveStatus::kCollided : DriveStatus::kArrived));
  arrival.reason = CheckReason::kArrival;
  arrival.name = metrics.tracking ? "reach the goal" : "complete the run";
  arrival.detail = EarlyEndReason(metrics);
  AddCheck(arrival, verdict);
  if (metrics.clearance && !expected.Collision()) {
    Check contact = CheckMetric(metrics, "collision", Relation::kEquals, "false");
    contact.reason = CheckReason::kNoContact;
    AddCheck(contact, verdict);
  }
  return arrival.met;
}

/// Adds a note to the verdict if the prescribed steering exceeds the limits of the car.
void NotePrescribedSteering(const PlantMetrics& metrics, Verdict& verdict) {
  const auto note = [&](const char* what, double was, double limit, const char* unit) {
    if (limit > 0.0 && was > (1.0 + kWheelCompliance) * limit) {
      verdict.notes.push_back(fmt::format(
          "{}: the prescribed steering {} of {:.4g} {} exceeds the vehicle limit of {:.4g} {}",
          metrics.plant, what, was, unit, limit, unit));
    }
  };
  note("angle", metrics.steering_max, metrics.steering_limit, "rad");
  note("rate", metrics.steering_rate_max, metrics.steering_rate_limit, "rad/s");
}

/// Returns whether any wheels lost contact with the road. Wheels in the air turn within the play of
/// their linkage, faster than the actuator, so their steering rate is not judged.
bool WheelsLeftTheRoad(const PlantMetrics& metrics) {
  return metrics.status == DriveStatus::kRolledOver || metrics.status == DriveStatus::kAirborne;
}

void JudgeSteeringRate(const PlantMetrics& metrics, Verdict& verdict) {
  if (metrics.steering_is_prescribed) {
    NotePrescribedSteering(metrics, verdict);
  } else if (metrics.steering_rate_limit > 0.0 && !WheelsLeftTheRoad(metrics)) {
    Check check = CheckMetric(metrics, "steering_rate_max", Relation::kAtMost,
                              (1.0 + kWheelCompliance) * metrics.steering_rate_limit);
    check.reason = CheckReason::kSteeringRate;
    check.detail = fmt::format("{:.4g}", metrics.steering_rate_limit);
    AddCheck(check, verdict);
  }
}

void JudgeCorridor(const PlantMetrics& metrics, Verdict& verdict) {
  if (metrics.tracking->corridor > 0.0) {
    Check check =
        CheckMetric(metrics, "cross_track.max", Relation::kAtMost, metrics.tracking->corridor);
    check.reason = CheckReason::kCorridor;
    AddCheck(check, verdict);
  }
}

/// Checks that the car's overspeed stays within its limit; if not, adds a note to the verdict.
void JudgeOverspeed(const PlantMetrics& metrics, Verdict& verdict) {
  const TrackingMetrics& tracking = *metrics.tracking;
  if (!tracking.overspeed_limit || !tracking.overspeed_max) {
    return;
  }
  Check check = CheckMetric(metrics, "overspeed_max", Relation::kAtMost, *tracking.overspeed_limit);
  check.reason = CheckReason::kOverspeed;
  if (!check.met) {
    verdict.notes.push_back(fmt::format(
        "{}: the car was {:.3g} m/s faster than planned; the speed control corrects up to {:.3g} "
        "m/s, where it brakes as hard as it may",
        metrics.plant, *tracking.overspeed_max, *tracking.overspeed_limit));
  }
  AddCheck(check, verdict);
}

/// Checks that the steering command has no sustained oscillation, unless an expectation replaces
/// this check. Adds a note to the verdict if the command oscillates.
void JudgeOscillation(const Expected& expected, const PlantMetrics& metrics, Verdict& verdict) {
  const OscillationMetrics& oscillation = *metrics.oscillation;
  if (oscillation.frequency) {
    const std::string share =
        metrics.steering_rate_limit > 0.0
            ? fmt::format(" ({:.0f} % of the limit)",
                          100.0 * oscillation.rate / metrics.steering_rate_limit)
            : "";
    verdict.notes.push_back(fmt::format(
        "{}: the steering oscillates at {:.3g} Hz between t = {:.4g} s and {:.4g} s; neither the "
        "path nor measurement noise explains it; it asks for {:.3g} rad/s{} and moves the car by "
        "about {:.2g} m to each side",
        metrics.plant, *oscillation.frequency, oscillation.from_t, oscillation.to_t,
        oscillation.rate, share, oscillation.sway));
  }
  if (!expected.HasMetric("oscillation.amplitude")) {
    Check check = CheckMetric(metrics, "oscillation.amplitude", Relation::kAtMost, 0.0);
    check.reason = CheckReason::kOscillation;
    check.detail = oscillation.frequency ? fmt::format("{:.3g}", *oscillation.frequency) : "";
    AddCheck(check, verdict);
  }
}

void NoteLimitedSteering(const PlantMetrics& metrics, Verdict& verdict) {
  constexpr double kNotedFraction = 0.02;
  if (metrics.maneuver && metrics.maneuver->steering_saturated_fraction > kNotedFraction) {
    verdict.notes.push_back(fmt::format("{}: steering limited ({:.0f} % of the time)",
                                        metrics.plant,
                                        100.0 * metrics.maneuver->steering_saturated_fraction));
  }
}

/// Adds a note to the verdict if a standard for stability control is applied to a car without one.
void NoteStabilityControl(const PlantMetrics& metrics, Verdict& verdict) {
  const bool has_esc = std::any_of(metrics.measured.begin(), metrics.measured.end(),
                                   [](const auto& own) { return own.first == "aids.esc_time"; });
  if (metrics.maneuver && metrics.maneuver->method == "sine_with_dwell" && !has_esc) {
    verdict.notes.push_back(fmt::format(
        "{}: the car has no electronic stability control (ESC), which ISO 19365 and FMVSS 126 test",
        metrics.plant));
  }
}

void JudgeMetric(const MetricExpectation& expect, const PlantMetrics& metrics, Verdict& verdict) {
  bool is_number = true;
  const auto check = [&](Relation relation, const MetricValue& bound) {
    if (is_number) {
      Check own = CheckMetric(metrics, expect.metric, relation, bound);
      // Report a missing or non-numeric metric only once, even if the metric has several bounds.
      const bool found = own.detail.empty();
      const bool number =
          std::holds_alternative<int>(own.value) || std::holds_alternative<double>(own.value);
      is_number = number || (found && relation == Relation::kEquals);
      AddCheck(std::move(own), verdict);
    }
  };
  if (expect.equals) {
    check(Relation::kEquals, *expect.equals);
  }
  if (expect.min) {
    check(Relation::kAtLeast, *expect.min);
  }
  if (expect.max) {
    check(Relation::kAtMost, *expect.max);
  }
}

void JudgePlant(const PlantExpectation& expect, const PlantMetrics& metrics, Verdict& verdict) {
  const auto check = [&](const std::optional<double>& bound, Relation relation, const char* metric,
                         const char* name) {
    if (bound) {
      Check own = CheckMetric(metrics, metric, relation, *bound);
      own.name = name;
      AddCheck(std::move(own), verdict);
    }
  };
  const auto is_measured = [&](std::string_view metric) {
    return std::any_of(metrics.measured.begin(), metrics.measured.end(),
                       [&](const auto& own) { return own.first == metric; });
  };
  for (const char* edges : {"track_limits.margin_min", "road_limits.margin_min"}) {
    if (is_measured(edges)) {
      check(expect.min_clearance, Relation::kAtLeast, edges, "clearance from the edges");
    }
  }
  if (metrics.clearance) {
    check(expect.min_clearance, Relation::kAtLeast, "clearance_min", "clearance");
    if (expect.collision) {
      Check own = CheckMetric(metrics, "collision", Relation::kEquals,
                              *expect.collision ? "true" : "false");
      own.reason = CheckReason::kCollision;
      own.detail = fmt::format("{:.4g}", metrics.clearance->min);
      AddCheck(std::move(own), verdict);
    }
  }
  check(expect.max_hitch_angle, Relation::kAtMost, "hitch_angle.max", "largest hitch angle");
  for (const MetricExpectation& metric : expect.metrics) {
    JudgeMetric(metric, metrics, verdict);
  }
  if (metrics.tracking) {
    constexpr Relation kAtMost = Relation::kAtMost;
    check(expect.reach_goal, kAtMost, "goal_distance", "distance to the goal");
    check(expect.max_cross_track, kAtMost, "cross_track.max", "maximum cross-track error");
    check(expect.rms_cross_track, kAtMost, "cross_track.rms", "rms cross-track error");
    check(expect.max_heading_error, kAtMost, "heading_error.max", "maximum heading error");
  }
}

void JudgeBetween(const BetweenExpectation& between,
                  const std::vector<PlantComparison>& comparisons, Verdict& verdict) {
  const std::string& first = between.plants[0];
  const std::string& second = between.plants[1];
  const auto found =
      std::find_if(comparisons.begin(), comparisons.end(), [&](const PlantComparison& c) {
        return (c.first == first && c.second == second) || (c.first == second && c.second == first);
      });
  if (found == comparisons.end()) {
    AddCheck({.plant = first,
              .other = second,
              .metric = "compared",
              .relation = Relation::kEquals,
              .bound = "true",
              .value = false,
              .reason = CheckReason::kComparable,
              .detail = "not both plants were run"},
             verdict);
    return;
  }
  for (Check& check : CheckBounds(between.bounds, *found)) {
    AddCheck(std::move(check), verdict);
  }
}

}  // namespace

Verdict Judge(const Expectations& expect, const std::vector<PlantMetrics>& plants,
              const std::vector<PlantComparison>& comparisons) {
  Verdict verdict;
  verdict.judged = HasExpectations(expect);
  for (const PlantMetrics& metrics : plants) {
    verdict.judged = verdict.judged || metrics.tracking || metrics.clearance;
    const Expected expected(expect, metrics.plant);
    if (JudgeEnd(expected, metrics, verdict) && !metrics.partial.empty()) {
      verdict.notes.push_back(fmt::format("{}: the plan {}", metrics.plant, metrics.partial));
    }
    JudgeSteeringRate(metrics, verdict);
    if (metrics.tracking && !expected.HasCrossTrack()) {
      JudgeCorridor(metrics, verdict);
    }
    if (metrics.tracking && !expected.HasMetric("overspeed_max")) {
      JudgeOverspeed(metrics, verdict);
    }
    if (metrics.oscillation) {
      JudgeOscillation(expected, metrics, verdict);
    }
    NoteLimitedSteering(metrics, verdict);
    NoteStabilityControl(metrics, verdict);
    for (const PlantExpectation* part : expected.parts()) {
      JudgePlant(*part, metrics, verdict);
    }
    for (const RequirementMetrics& requirement : metrics.requirements) {
      AddCheck(CheckRequirement(metrics.plant, requirement), verdict);
    }
  }
  for (const BetweenExpectation& between : expect.between) {
    JudgeBetween(between, comparisons, verdict);
  }
  verdict.judged = verdict.judged || !verdict.failures.empty();
  verdict.passed = verdict.judged && verdict.failures.empty();
  return verdict;
}

void AddCheck(Check check, Verdict& verdict) {
  if (!check.met) {
    if (std::string message = FailureMessage(check); !message.empty()) {
      verdict.failures.push_back(std::move(message));
    }
  }
  verdict.checks.push_back(std::move(check));
}

nlohmann::ordered_json ToJson(const Verdict& verdict) {
  using nlohmann::ordered_json;
  ordered_json json{
      {"passed", verdict.judged ? ordered_json(verdict.passed) : ordered_json(nullptr)},
      {"failures", verdict.failures},
      {"notes", verdict.notes},
      {"checks", ordered_json::array()}};
  for (const Check& check : verdict.checks) {
    json["checks"].push_back(ToJson(check));
  }
  return json;
}

}  // namespace trackbed
