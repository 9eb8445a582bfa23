#include "trackbed/analysis/metrics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "src/analysis/metric_table.h"
#include "src/analysis/peaks.h"
#include "src/analysis/steering_metrics.h"
#include "src/analysis/track_metrics.h"
#include "src/analysis/waypoint_metrics.h"
#include "trackbed/analysis/compare.h"
#include "trackbed/analysis/metric_registry.h"
#include "trackbed/control/steering_controller.h"
#include "trackbed/core/angle.h"
#include "trackbed/core/error.h"
#include "trackbed/planning/common/plan.h"

namespace trackbed {
namespace {

/// Duration over which measured accelerations and steering rates are averaged [s].
constexpr double kWindow = 0.1;

void MeasureOverspeed(const LogRow& row, TrackingMetrics& metrics) {
  if (!row.planned_speed) {
    return;
  }
  const double over = std::max(0.0, std::abs(row.state.speed) - *row.planned_speed);
  if (!metrics.overspeed_max || over > *metrics.overspeed_max) {
    metrics.overspeed_max = over;
    metrics.overspeed_max_s = row.tracking->s;
    metrics.overspeed_max_t = row.state.time;
  }
}

TrackingMetrics MeasureTracking(const RunLog& log, const Pose2& goal, double corridor) {
  TrackingMetrics metrics{.corridor = corridor};
  double cross_track_squares = 0.0;
  double heading_squares = 0.0;
  double rows = 0.0;
  for (const LogRow& row : log.rows) {
    if (log.contact_time && row.state.time > *log.contact_time && rows > 0.0) {
      // Ignore the rows after the contact, in which an obstacle pushes the car and the steering no
      // longer determines the motion.
      break;
    }
    rows += 1.0;
    const Projection& at = *row.tracking;
    cross_track_squares += at.cross_track * at.cross_track;
    heading_squares += at.heading_error * at.heading_error;
    if (std::abs(at.cross_track) > metrics.cross_track_max) {
      metrics.cross_track_max = std::abs(at.cross_track);
      metrics.cross_track_max_s = at.s;
      metrics.cross_track_max_t = row.state.time;
    }
    MeasureOverspeed(row, metrics);
    if (std::abs(at.heading_error) > metrics.heading_error_max) {
      metrics.heading_error_max = std::abs(at.heading_error);
      metrics.heading_error_max_s = at.s;
      metrics.heading_error_max_t = row.state.time;
    }
  }
  metrics.cross_track_rms = std::sqrt(cross_track_squares / rows);
  metrics.heading_error_rms = std::sqrt(heading_squares / rows);
  const LogRow& last = log.rows.back();
  metrics.cross_track_final = last.tracking->cross_track;
  metrics.goal_distance = (last.state.pose.position() - goal.position()).norm();
  metrics.goal_heading_error = AngleDifference(last.state.pose.yaw, goal.yaw);
  return metrics;
}

ClearanceMetrics MeasureClearance(const RunLog& log) {
  ClearanceMetrics metrics;
  metrics.min = std::numeric_limits<double>::infinity();
  for (const LogRow& row : log.rows) {
    if (*row.clearance < metrics.min) {
      metrics.min = *row.clearance;
      metrics.min_s = RowStation(row);
      metrics.min_t = row.state.time;
    }
    if (row.state.obstacle_force > metrics.force_max) {
      metrics.force_max = row.state.obstacle_force;
      metrics.force_max_s = RowStation(row);
      metrics.force_max_t = row.state.time;
    }
  }
  metrics.collision = log.contact_time.has_value();
  if (log.contact_time) {
    // Use the exact time of contact, which lies between two log rows.
    metrics.min_t = *log.contact_time;
  }
  return metrics;
}

void PlaceContact(const RunLog& log, PlantMetrics& metrics) {
  if (!log.contact_time) {
    return;
  }
  metrics.contact_t = *log.contact_time;
  const auto row = std::find_if(log.rows.begin(), log.rows.end(), [&](const LogRow& own) {
    return own.state.time >= metrics.contact_t;
  });
  metrics.contact_s = row == log.rows.end() ? metrics.end_s : RowStation(*row);
}

/// Returns the root mean square of the measured steering rate; the rate in each control period is
/// the change of the steering angle divided by the period.
double SteeringRateRms(const RunLog& log, double control_period) {
  double squares = 0.0;
  for (std::size_t i = 1; i < log.rows.size(); ++i) {
    const double change = log.rows[i].state.steering - log.rows[i - 1].state.steering;
    squares += change * change;
  }
  const auto periods = static_cast<double>(std::max<std::size_t>(log.rows.size(), 2) - 1);
  return std::sqrt(squares / periods) / control_period;
}

std::optional<double> YawRateRatio(const RunLog& log, double wheelbase) {
  double products = 0.0;
  double squares = 0.0;
  for (const LogRow& row : log.rows) {
    const double kinematic = row.state.speed * std::tan(row.state.steering) / wheelbase;
    products += row.state.yaw_rate * kinematic;
    squares += kinematic * kinematic;
  }
  const bool turned = squares > 1e-6 * static_cast<double>(log.rows.size());
  return turned ? std::optional(products / squares) : std::nullopt;
}

std::vector<TurnMetrics> MeasureTurns(const RunLog& log, const Plan& plan,
                                      const VehicleParams& vehicle, StationSource source) {
  std::vector<TurnMetrics> turns;
  const Trace trace = MakeTrace(log, source);
  // Account for the lag between the steering actuator and the steered wheels only in plants that
  // simulate wheels.
  const double lag = log.rows.front().state.wheels ? vehicle.steering_lag : 0.0;
  // Evaluate only turns before the first change of plan, because later stations in the log refer to
  // another path.
  const double until =
      log.changes.empty() ? std::numeric_limits<double>::infinity() : log.changes.front().station;
  for (const IsolatedTurn& turn : plan.turns) {
    if (trace.station.size() > 2 && turn.middle <= until && trace.station.front() <= turn.from &&
        turn.middle <= trace.station.back()) {
      const Path& path = plan.reference.path;
      turns.push_back({turn.waypoint, PredictTurn(vehicle, path, turn, lag),
                       ErrorInTurn(path, turn, trace.PoseAt(turn.from), trace.PoseAt(turn.middle)),
                       turn.middle, trace.TimeAt(turn.middle)});
    }
  }
  return turns;
}

}  // namespace

PlantMetrics Measure(const RunLog& log, const Plan& plan, const VehicleParams& vehicle,
                     double control_period, StationSource source) {
  TRACKBED_CHECK(!log.rows.empty(), "the log of {} is empty", log.plant);
  PlantMetrics metrics;
  metrics.plant = log.plant;
  metrics.status = log.status;
  metrics.cause = log.cause;
  metrics.distance = log.rows.back().state.distance;
  metrics.time = log.rows.back().state.time;
  metrics.end_s = RowStation(log.rows.back());
  PlaceContact(log, metrics);
  const auto window = static_cast<std::size_t>(std::max(1.0, std::round(kWindow / control_period)));
  MeasureLateralAcceleration(log, window, metrics);
  MeasureSteering(log, window, metrics);
  metrics.steering_rate_limit = vehicle.steering_rate;
  metrics.steering_limit = vehicle.steering_limit;
  metrics.steering_rate_rms = SteeringRateRms(log, control_period);
  metrics.steering_saturated_fraction =
      SaturatedFraction(log, vehicle, log.rows.front().state.time, metrics.time);
  metrics.steering_reversals = SteeringReversals(log, vehicle);
  if (vehicle.steering_rate > 0.0) {
    metrics.steering_activity = metrics.steering_rate_rms / vehicle.steering_rate;
  }
  metrics.oscillation = MeasureOscillation(log, plan, vehicle);
  metrics.yaw_rate_ratio = YawRateRatio(log, vehicle.wheelbase);
  if (log.rows.front().tracking) {
    metrics.tracking = MeasureTracking(log, plan.goal, vehicle.width);
  }
  metrics.waypoint_miss = MeasureWaypointMiss(log, plan);
  if (log.rows.front().clearance) {
    metrics.clearance = MeasureClearance(log);
  }
  metrics.plan_changes = static_cast<int>(log.changes.size());
  metrics.blocked = (log.changes.empty() ? plan : log.changes.back().plan).blocked;
  metrics.partial = plan.partial;
  metrics.turns = MeasureTurns(log, plan, vehicle, source);
  metrics.laps = MeasureLaps(log, plan);
  for (const MetricEntry& entry : Metrics()) {
    if (entry.measure) {
      if (const auto reading = entry.measure({log, plan, vehicle})) {
        metrics.measured.emplace_back(entry.path, *reading);
      }
    }
  }
  return metrics;
}

nlohmann::ordered_json ToJson(const PlantMetrics& metrics) {
  nlohmann::ordered_json json;
  for (const Metric& metric : ListMetrics(metrics)) {
    PutMetric(metric, json);
  }
  return json;
}

std::vector<std::string> PossibleMetrics(const Scenario& scenario) {
  std::vector<std::string> paths;
  for (const Metric& metric : ListMetrics(AllMetrics(scenario, ""))) {
    paths.push_back(metric.path);
  }
  return paths;
}

}  // namespace trackbed
