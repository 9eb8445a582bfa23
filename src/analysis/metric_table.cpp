#include "src/analysis/metric_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "src/analysis/aid_metrics.h"
#include "src/analysis/predicted_time.h"
#include "src/analysis/road_metrics.h"
#include "src/analysis/sideslip.h"
#include "src/analysis/track_metrics.h"
#include "src/analysis/trailer_metrics.h"
#include "trackbed/planning/registry/planners.h"

// Table of all metrics that Trackbed defines, with one entry per metric.
// 1. Most entries have `read`, a function that takes the value from PlantMetrics: Of() reads a
//    member, At() a member with the station and time at which the value occurs.
// 2. Other entries have `measure`, a function that computes the value from the log.
// 3. AllMetrics gives a dummy value to every metric that a run of a scenario can have, so that the
//    paths of metrics can be checked before the run.
namespace trackbed {
namespace {

using Reading = std::optional<MetricReading>;
using Read = std::function<Reading(const PlantMetrics&)>;

// Returns the part of a plant's metrics that has the same type as the argument `which`, whose value
// is ignored. SelectMetrics returns null if the run did not measure the metrics of the requested
// type.
const PlantMetrics* SelectMetrics(const PlantMetrics& metrics, const PlantMetrics* /*which*/) {
  return &metrics;
}
const TrackingMetrics* SelectMetrics(const PlantMetrics& metrics,
                                     const TrackingMetrics* /*which*/) {
  return metrics.tracking ? &*metrics.tracking : nullptr;
}
const ClearanceMetrics* SelectMetrics(const PlantMetrics& metrics,
                                      const ClearanceMetrics* /*which*/) {
  return metrics.clearance ? &*metrics.clearance : nullptr;
}

const WaypointMissMetrics* SelectMetrics(const PlantMetrics& metrics,
                                         const WaypointMissMetrics* /*which*/) {
  return metrics.waypoint_miss ? &*metrics.waypoint_miss : nullptr;
}

const RecordMetrics* SelectMetrics(const PlantMetrics& metrics, const RecordMetrics* /*which*/) {
  return metrics.recorded ? &*metrics.recorded : nullptr;
}

/// Returns a function that reads the member `value` of the metrics. The argument `span` tells
/// whether the value describes the whole run or the end of the run.
template <typename Part, typename T>
Read Of(T Part::*value, MetricSpan span = MetricSpan::kRun) {
  return [=](const PlantMetrics& metrics) -> Reading {
    const Part* part = SelectMetrics(metrics, static_cast<const Part*>(nullptr));
    return part == nullptr ? Reading() : MetricReading{part->*value, {.span = span}};
  };
}

/// Returns a function that reads the member `value` of the metrics. The members `s` and `t` contain
/// the station and the time at which the value occurs.
template <typename Part, typename T>
Read At(T Part::*value, double Part::*s, double Part::*t) {
  return [=](const PlantMetrics& metrics) -> Reading {
    const Part* part = SelectMetrics(metrics, static_cast<const Part*>(nullptr));
    return part == nullptr
               ? Reading()
               : MetricReading{part->*value,
                               {.span = MetricSpan::kMoment, .s = part->*s, .t = part->*t}};
  };
}

Reading Status(const PlantMetrics& metrics) {
  // Use the time of contact as the end of the run, because the simulation continues for one second
  // after a collision.
  const bool collided = metrics.status == DriveStatus::kCollided;
  return MetricReading{std::string(ToString(metrics.status)),
                       {.span = collided ? MetricSpan::kMoment : MetricSpan::kEnd,
                        .s = collided ? metrics.contact_s : metrics.end_s,
                        .t = collided ? metrics.contact_t : metrics.time}};
}

Read TextUnlessEmpty(std::string PlantMetrics::*text) {
  return [=](const PlantMetrics& metrics) {
    return (metrics.*text).empty() ? Reading() : MetricReading{metrics.*text, {}};
  };
}

Reading RecoveryTime(const PlantMetrics& metrics) {
  if (!metrics.recovery) {
    return std::nullopt;
  }
  MetricReading reading{.value = {},
                        .at = {.span = MetricSpan::kSince, .from_t = metrics.recovery->from}};
  if (metrics.recovery->time) {
    reading.value = *metrics.recovery->time;
  }
  return reading;
}

Reading YawRateRatio(const PlantMetrics& metrics) {
  return metrics.yaw_rate_ratio ? Reading({*metrics.yaw_rate_ratio, {}}) : Reading();
}

Reading SteeringActivity(const PlantMetrics& metrics) {
  return metrics.steering_activity ? Reading({*metrics.steering_activity, {}}) : Reading();
}

MetricPlace PlaceOf(const OscillationMetrics& oscillation) {
  return oscillation.frequency ? MetricPlace{.span = MetricSpan::kInterval,
                                             .t = oscillation.to_t,
                                             .from_t = oscillation.from_t}
                               : MetricPlace{};
}

Reading OscillationAmplitude(const PlantMetrics& metrics) {
  return metrics.oscillation
             ? Reading({metrics.oscillation->amplitude, PlaceOf(*metrics.oscillation)})
             : Reading();
}

Reading OscillationFrequency(const PlantMetrics& metrics) {
  if (!metrics.oscillation) {
    return std::nullopt;
  }
  MetricReading reading{.value = {}, .at = PlaceOf(*metrics.oscillation)};
  if (metrics.oscillation->frequency) {
    reading.value = *metrics.oscillation->frequency;
  }
  return reading;
}

Reading Overspeed(const PlantMetrics& metrics) {
  if (!metrics.tracking || !metrics.tracking->overspeed_max) {
    return std::nullopt;
  }
  return MetricReading{*metrics.tracking->overspeed_max,
                       {.span = MetricSpan::kMoment,
                        .s = metrics.tracking->overspeed_max_s,
                        .t = metrics.tracking->overspeed_max_t}};
}

MetricEntry Headline(MetricEntry entry) {
  entry.headline = true;
  return entry;
}

/// Changes a metric entry so that metrics.json also contains the station and the time at which the
/// value occurs.
MetricEntry Located(MetricEntry entry) {
  entry.located = true;
  return entry;
}

/// Metrics of how a plant drives along its plan, read from PlantMetrics.
std::vector<MetricEntry> DriveMetrics() {
  using P = PlantMetrics;
  using T = TrackingMetrics;
  using C = ClearanceMetrics;
  using W = WaypointMissMetrics;
  constexpr MetricSpan kEnd = MetricSpan::kEnd;
  return {
      Located({"status", "End status", "", Status}),
      {"cause", "Cause of the end", "", TextUnlessEmpty(&P::cause)},
      {"distance", "Distance traveled", "m", Of(&P::distance, kEnd)},
      Headline({"time", "Time", "s", Of(&P::time, kEnd)}),
      {"cross_track.rms", "Cross-track error, rms", "m", Of(&T::cross_track_rms)},
      Headline(Located({"cross_track.max", "Maximum cross-track error", "m",
                        At(&T::cross_track_max, &T::cross_track_max_s, &T::cross_track_max_t)})),
      {"cross_track.final", "Cross-track error at the end", "m", Of(&T::cross_track_final, kEnd)},
      {"heading_error.rms", "Heading error, rms", "rad", Of(&T::heading_error_rms)},
      Headline(
          Located({"heading_error.max", "Maximum heading error", "rad",
                   At(&T::heading_error_max, &T::heading_error_max_s, &T::heading_error_max_t)})),
      Headline({"goal_distance", "Distance to the goal", "m", Of(&T::goal_distance, kEnd)}),
      {"goal_heading_error", "Heading error at the goal", "rad", Of(&T::goal_heading_error, kEnd)},
      Located({"waypoint_miss.max", "Largest distance from a waypoint", "m",
               At(&W::max, &W::max_s, &W::max_t)}),
      {"waypoint_miss.waypoint", "Waypoint with the largest distance", "", Of(&W::waypoint)},
      {"waypoint_miss.planned", "Largest distance of the plan from a waypoint", "m",
       Of(&W::planned)},
      Located({"overspeed_max", "Maximum speed above the plan", "m/s", Overspeed}),
      Headline(
          Located({"clearance_min", "Minimum clearance", "m", At(&C::min, &C::min_s, &C::min_t)})),
      {"collision", "Collision", "", At(&C::collision, &C::min_s, &C::min_t)},
      {"obstacle_force_max", "Maximum obstacle contact force", "N",
       At(&C::force_max, &C::force_max_s, &C::force_max_t)},
      {"recovery_time", "Recovery time", "s", RecoveryTime},
      {"plan_changes", "Replans", "", Of(&P::plan_changes)},
      {"blocked", "Blocked", "", TextUnlessEmpty(&P::blocked)},
      {"partial", "Partial plan", "", TextUnlessEmpty(&P::partial)},
  };
}

/// Metrics of the accelerations, the steering and the yaw of a plant, read from PlantMetrics.
std::vector<MetricEntry> MotionMetrics() {
  using P = PlantMetrics;
  return {
      Headline(
          Located({"lateral_acceleration_max", "Maximum lateral acceleration (0.1 s mean)", "m/s^2",
                   At(&P::lateral_acceleration_max, &P::lateral_acceleration_max_s,
                      &P::lateral_acceleration_max_t)})),
      {"steering_max", "Maximum steering angle", "rad", Of(&P::steering_max)},
      Located({"steering_rate_max", "Maximum steering rate (0.1 s mean)", "rad/s",
               At(&P::steering_rate_max, &P::steering_rate_max_s, &P::steering_rate_max_t)}),
      {"steering_rate_rms", "Steering rate, rms", "rad/s", Of(&P::steering_rate_rms)},
      {"steering_saturated_fraction", "Fraction of time at a steering limit", "",
       Of(&P::steering_saturated_fraction)},
      {"steering_reversals", "Reversals of the steering command", "1/s",
       Of(&P::steering_reversals)},
      {"steering_activity", "Steering rate, rms, over the largest steering rate", "",
       SteeringActivity},
      Headline({"oscillation.amplitude", "Sustained oscillation of the steering command", "rad",
                OscillationAmplitude}),
      {"oscillation.frequency", "Frequency of the oscillation", "Hz", OscillationFrequency},
      {"yaw_rate_ratio", "Yaw rate relative to the kinematic model", "", YawRateRatio},
  };
}

/// Metrics of a plant against the recorded drive of the scenario, read from PlantMetrics.
std::vector<MetricEntry> RecordEntries() {
  using R = RecordMetrics;
  constexpr MetricSpan kEnd = MetricSpan::kEnd;
  return {
      Headline({"recorded.yaw_rate.relative_rms", "Yaw rate against the record, relative rms", "",
                Of(&R::yaw_rate_relative_rms)}),
      {"recorded.lateral_acceleration.relative_rms",
       "Lateral acceleration against the record, relative rms", "",
       Of(&R::lateral_acceleration_relative_rms)},
      {"recorded.position.rms", "Distance from the record, rms", "m", Of(&R::position_rms)},
      Headline(Located({"recorded.position.max", "Maximum distance from the record", "m",
                        At(&R::position_max, &R::position_max_s, &R::position_max_t)})),
      {"recorded.position.final", "Distance from the record at the end", "m",
       Of(&R::position_final, kEnd)},
      {"recorded.heading.rms", "Heading against the record, rms", "rad", Of(&R::heading_rms)},
      Located({"recorded.heading.max", "Maximum heading difference from the record", "rad",
               At(&R::heading_max, &R::heading_max_s, &R::heading_max_t)}),
  };
}

/// Metrics that are computed from the log.
std::vector<MetricEntry> LogEntries() {
  return {
      Located({"sideslip_max", "Maximum sideslip angle", "rad", {}, LargestSideslip}),
      {"predicted_time", "Time predicted at the limit", "s", {}, PredictedTime},
      {"time_over_predicted", "Time over the predicted one", "", {}, TimeOverPredicted},
      Headline(Located({"track_limits.margin_min",
                        "Smallest distance from the track's edges (negative: beyond)",
                        "m",
                        {},
                        SmallestTrackMargin})),
      {"track_limits.margin_planned",
       "Smallest distance of the planned path from the track's edges",
       "m",
       {},
       PlannedTrackMargin},
      Headline(Located({"road_limits.margin_min",
                        "Smallest distance from the road's edges (negative: beyond)",
                        "m",
                        {},
                        SmallestRoadMargin})),
      {"track_limits.time_off", "Time off the track", "s", {}, TimeOffTrack},
      {"track_limits.distance_off", "Distance off the track", "m", {}, DistanceOffTrack},
      {"aids.abs_time", "Time with anti-lock control", "s", {}, TimeOfAbs},
      {"aids.esc_time", "Time with stability control", "s", {}, TimeOfEsc},
      {"aids.esc_brake_torque_max",
       "Largest brake torque of stability control",
       "N m",
       {},
       LargestEscTorque},
      Headline(Located(
          {"hitch_angle.max", "Largest hitch angle of the trailer", "rad", {}, LargestHitchAngle})),
      Located({"hitch_rate.max", "Largest rate of the hitch angle", "rad/s", {}, LargestHitchRate}),
      Located({"off_tracking.max",
               "Largest off-tracking of the trailer's axle",
               "m",
               {},
               LargestOffTracking}),
  };
}

}  // namespace

std::vector<MetricEntry> BuiltInMetrics() {
  std::vector<MetricEntry> all;
  for (const std::vector<MetricEntry>& part :
       std::array{DriveMetrics(), MotionMetrics(), RecordEntries(), LogEntries()}) {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

const std::vector<TurnMetricEntry>& TurnMetricTable() {
  using T = const TurnMetrics&;
  static const std::vector<TurnMetricEntry> table{
      {"waypoint", "waypoint", "", [](T turn) -> MetricValue { return turn.waypoint; }},
      {"heading_deficit_predicted", "heading deficit, predicted", "rad",
       [](T turn) -> MetricValue { return turn.predicted.heading_deficit; }},
      {"heading_deficit", "heading deficit", "rad",
       [](T turn) -> MetricValue { return turn.measured.heading_deficit; }},
      {"lateral_offset_predicted", "lateral offset, predicted", "m",
       [](T turn) -> MetricValue { return turn.predicted.lateral_offset; }},
      {"lateral_offset", "lateral offset", "m",
       [](T turn) -> MetricValue { return turn.measured.lateral_offset; }}};
  return table;
}

const std::vector<LapMetricEntry>& LapMetricTable() {
  using L = const LapMetrics&;
  static const std::vector<LapMetricEntry> table{
      {"time", "time", "s", [](L lap) -> MetricValue { return lap.time; }},
      {"time_planned", "time, planned", "s",
       [](L lap) -> MetricValue { return lap.time_planned; }}};
  return table;
}

const std::vector<WindowMetricEntry>& WindowMetricTable() {
  using E = const WindowErrors&;
  static const auto known = [](E errors, double value) -> MetricValue {
    return errors.count > 0 && std::isfinite(value) ? MetricValue(value) : MetricValue();
  };
  static const std::vector<WindowMetricEntry> table{
      {"horizon", "horizon", "s", [](E errors) -> MetricValue { return errors.horizon; }},
      {"count", "windows", "", [](E errors) -> MetricValue { return errors.count; }},
      {"diverged", "windows that diverged", "",
       [](E errors) -> MetricValue { return errors.diverged; }},
      {"position.median", "position error at the end, median", "m",
       [](E errors) { return known(errors, errors.position_median); }},
      {"position.p90", "position error at the end, 90 %", "m",
       [](E errors) { return known(errors, errors.position_p90); }},
      {"heading.median", "heading error at the end, median", "rad",
       [](E errors) { return known(errors, errors.heading_median); }},
      {"heading.p90", "heading error at the end, 90 %", "rad",
       [](E errors) { return known(errors, errors.heading_p90); }},
      {"yaw_rate.relative_rms", "yaw rate, relative rms", "",
       [](E errors) { return known(errors, errors.yaw_rate_relative_rms); }},
      {"lateral_acceleration.relative_rms", "lateral acceleration, relative rms", "",
       [](E errors) { return known(errors, errors.lateral_acceleration_relative_rms); }}};
  return table;
}

void PutMetric(const Metric& metric, nlohmann::ordered_json& json) {
  std::string pointer = "/";
  for (const char c : metric.path) {
    if (c != ']') {
      pointer += c == '.' || c == '[' ? '/' : c;
    }
  }
  json[nlohmann::ordered_json::json_pointer(pointer)] = ToJson(metric.value);
}

PlantMetrics AllMetrics(const Scenario& scenario, const std::string& plant) {
  PlantMetrics metrics;
  metrics.plant = plant;
  metrics.yaw_rate_ratio = 1.0;
  metrics.steering_activity = 0.0;
  if (scenario.plan) {
    metrics.oscillation.emplace();
    metrics.tracking.emplace().overspeed_max = 0.0;
    constexpr double kAnyTime = std::numeric_limits<double>::infinity();
    if (DisturbedUntil(scenario.disturb, scenario.world.wind, kAnyTime)) {
      metrics.recovery.emplace();
    }
    metrics.blocked = scenario.plan->avoid ? "why" : "";
    metrics.partial = MayBePartial(scenario.plan->global) ? "why" : "";
    if (scenario.mission.waypoints.size() > 1) {
      metrics.waypoint_miss.emplace();
    }
    // The path turns at most once at each waypoint between the first and the last waypoint.
    metrics.turns.resize(std::max<std::size_t>(scenario.mission.waypoints.size(), 2) - 2);
  }
  if (HasObstacles(scenario.world)) {
    metrics.clearance.emplace();
  }
  if (scenario.maneuver) {
    metrics.maneuver = AllMetrics(*scenario.maneuver);
  }
  if (scenario.record) {
    metrics.recorded.emplace();
    metrics.windows.resize(scenario.record->windows.size());
  }
  std::set<std::string> requirements;
  const auto require = [&](const PlantExpectation& expect) {
    for (const RequirementExpectation& own : expect.requirements) {
      if (requirements.insert(own.name).second) {
        metrics.requirements.push_back({.name = own.name, .robustness = 0.0});
      }
    }
  };
  require(scenario.expect.all);
  for (const auto& [name, own] : scenario.expect.plants) {
    if (plant.empty() || name == plant) {
      require(own);
    }
  }
  if (scenario.mission.track) {
    metrics.laps.resize(static_cast<std::size_t>(scenario.mission.track->laps));
  }
  const AidOptions aids = scenario.vehicle.aids.value_or(AidOptions{});
  for (const MetricEntry& entry : Metrics()) {
    // Metrics of track limits exist only for runs on a track, and metrics of road limits only for
    // routes over lanes. Metrics of driver aids and of trailers exist only for cars with these aids
    // or a trailer.
    const bool of_track = entry.path.starts_with("track_limits.");
    const bool of_road = entry.path.starts_with("road_limits.");
    const bool of_abs = entry.path.starts_with("aids.abs_");
    const bool of_esc = entry.path.starts_with("aids.esc_");
    const bool of_trailer =
        entry.path.starts_with("hitch_") || entry.path.starts_with("off_tracking.");
    if (entry.measure && (!of_track || scenario.mission.track) &&
        (!of_road || !scenario.mission.route.empty()) && (!of_abs || aids.abs) &&
        (!of_esc || aids.esc) && (!of_trailer || scenario.vehicle.trailer)) {
      metrics.measured.emplace_back(entry.path, MetricReading{0.0, {}});
    }
  }
  return metrics;
}

}  // namespace trackbed
